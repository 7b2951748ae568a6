#include <algorithm>
#include <cmath>
#include <limits>

#include "twins/finite.h"
#include "twins/instance.h"
#include "twins/intersect.h"
#include "twins/trace_counts.h"
#include "twins/vectors.h"

namespace coppice::twins {

namespace {

// A ray as the boxes of one level see it.
struct LevelRay {
  vec3 origin, inverse, room, pad;
};

LevelRay in_mesh(const TraceRay& ray, const PlacedInstance& placed, const Affine& transform) {
  const vec3 way(ray.origin.x - transform.at[0][3], ray.origin.y - transform.at[1][3],
                 ray.origin.z - transform.at[2][3]);
  const float distance = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
  const vec3* const rows[] = {&placed.row_x, &placed.row_y, &placed.row_z};
  const float rooms[] = {placed.room_x, placed.room_y, placed.room_z};
  LevelRay level;
  for (int axis = 0; axis < 3; ++axis) {
    level.origin[axis] = dot_product(*rows[axis], way);
    float direction = dot_product(*rows[axis], ray.direction);
    const float least = rooms[axis] * 0x1p-21f;
    if (std::fabs(direction) < least) direction = direction < 0 ? -least : least;
    level.inverse[axis] = 1.0f / direction;
    const float pad = distance <= 0x1p60f ? rooms[axis] * distance + placed.pad[axis]
                                          : std::numeric_limits<float>::infinity();
    level.pad[axis] = pad * std::fabs(level.inverse[axis]);
    level.room[axis] = std::fabs(level.inverse[axis]) * (24 * 0x1p-24f);
  }
  return level;
}

struct Found {
  Hit hit;
  uint instance;
};

// One ray's way through both levels.
class InstanceTrace {
 public:
  InstanceTrace(const TraceInstancesArgs& args, const TraceRay& ray, Found& found)
      : args_(args), ray_(ray), found_(found) {}

  void run() {
    const LevelRay world{ray_.origin, ray_.inverse, ray_.room, vec3(0)};
    walk_from_root(world, args_.nodes, [this](uint instance) { enter(instance); });
  }

  std::uint64_t steps = 0;  // pairs of children, of both levels

 private:
  struct Met {
    const Node* node;
    float enter;
  };

  bool meets(const LevelRay& level, const Node& node, float& enter) const {
    float reach = 0, leave = found_.hit.t;
    for (int axis = 0; axis < 3; ++axis) {
      reach = std::max({reach, std::fabs(node.box_min[axis] - level.origin[axis]),
                        std::fabs(node.box_max[axis] - level.origin[axis])});
    }
    enter = ray_.t_min;
    for (int axis = 0; axis < 3; ++axis) {
      float near = (node.box_min[axis] - level.origin[axis]) * level.inverse[axis];
      float far = (node.box_max[axis] - level.origin[axis]) * level.inverse[axis];
      if (level.inverse[axis] < 0) std::swap(near, far);
      const float pad = level.room[axis] * reach + level.pad[axis];
      if (near - pad > enter) enter = near - pad;
      if (far + pad < leave) leave = far + pad;
    }
    return enter <= leave;
  }

  template <class Leaf>
  void walk_from_root(const LevelRay& level, Address<const Node> nodes, const Leaf& leaf) {
    float enter;
    if (meets(level, nodes[0], enter)) walk(level, nodes, nodes[0], leaf);
  }

  // The nearer child first; the other one if it still begins before the closest hit.
  template <class Leaf>
  void walk(const LevelRay& level, Address<const Node> nodes, const Node& node, const Leaf& leaf) {
    if (node.height == 0) return leaf(node.child);
    ++steps;
    Met met[2];
    int count = 0;
    for (const uint child : {node.child, node.child + 1}) {
      met[count].node = &nodes[child];
      if (meets(level, nodes[child], met[count].enter)) ++count;
    }
    if (count == 2 && met[1].enter < met[0].enter) std::swap(met[0], met[1]);
    for (int i = 0; i < count; ++i) {
      if (met[i].enter <= found_.hit.t) walk(level, nodes, *met[i].node, leaf);
    }
  }

  void enter(uint instance) {
    const PlacedInstance& placed = args_.placed[instance];
    const MeshRange& mesh = args_.meshes[placed.mesh];
    const Affine transform(args_.transforms[instance]);
    walk_from_root(in_mesh(ray_, placed, transform),
                   {args_.mesh_nodes.value + sizeof(Node) * mesh.first_node},
                   [&](uint triangle) { test(instance, transform, mesh.first_triangle, triangle); });
  }

  void test(uint instance, const Affine& transform, uint first, uint triangle) {
    const Triangle& own = args_.mesh_triangles[std::size_t{first} + triangle];
    const Triangle moved{transform(own.a), transform(own.b), transform(own.c)};
    if (!all_finite(moved.a) || !all_finite(moved.b) || !all_finite(moved.c)) return;
    // By itself, as far as the closest hit; then by rank.
    Hit hit{found_.hit.t, NO_TRIANGLE, 0, 0};
    ray_meets_triangle(ray_, moved, triangle, TRIANGLE_WATERTIGHT, hit);
    if (hit.triangle == NO_TRIANGLE) return;
    const bool has_tie = hit.t == found_.hit.t && found_.instance != NO_INSTANCE;
    const bool comes_first =
        instance != found_.instance ? instance < found_.instance : triangle < found_.hit.triangle;
    if (!has_tie || comes_first) found_ = {hit, instance};
  }

  const TraceInstancesArgs& args_;
  const TraceRay& ray_;
  Found& found_;
};

// Steps.
std::uint64_t trace(const TraceInstancesArgs& args, uint i) {
  TraceRay ray(args.rays[i]);
  if (!ray.is_sound) return 0;
  ray.approach(args.nodes[0].box_min, args.nodes[0].box_max);
  Hit& so_far = args.hits[i];
  uint& instance = args.hit_instances[i];
  const Found before{ray.prepared(so_far), instance};
  Found found = before;
  InstanceTrace walk(args, ray, found);
  walk.run();
  if (found.instance == before.instance && found.hit.triangle == before.hit.triangle) return walk.steps;
  if (std::isinf(ray.given_t(found.hit.t))) return walk.steps;
  so_far.triangle = NO_TRIANGLE;
  ray.keep(found.hit, so_far);
  instance = found.instance;
  return walk.steps;
}

}  // namespace

void trace_instances(const TraceInstancesArgs& args) {
  const bool empty = args.state[0].active_count == 0;
  if (!empty && args.nodes[0].height + args.mesh_height[0] > args.stack_entries) {
    args.state[0].error_word |= ERROR_TREE_TOO_DEEP;
    return;
  }
  for (uint i = 0; i < args.ray_count; ++i) {
    if (args.hits[i].triangle == NO_TRIANGLE) args.hit_instances[i] = NO_INSTANCE;
    const std::uint64_t steps = empty ? 0 : trace(args, i);
    count_into(args.counters[0].steps, steps);
    keep_ray_steps(args, i, static_cast<uint>(steps));
    count_into(args.counters[0].rays, 1);
    count_into(args.counters[0].hits, args.hits[i].triangle != NO_TRIANGLE);
  }
}

}  // namespace coppice::twins
