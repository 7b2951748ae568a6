#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "interface/trace.h"
#include "twins/count_error.h"
#include "twins/intersect.h"
#include "twins/sight.h"
#include "twins/trace_counts.h"

namespace coppice::twins {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Interval {
  float low = infinity, high = -infinity;

  void add(float x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

// Products of a difference with reciprocals from `inverse`: the least or the greatest.
float least_product(float difference, const Interval& inverse) {
  return difference * (difference < 0 ? inverse.high : inverse.low);
}

uint step_bits(const WideNode& node, int axis) { return (node.exponents >> (8 * axis) & 0xff) << 23; }

// The slab test for all rays of a packet at once.
class Bundle {
 public:
  void add(const TraceRay& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis].add(ray.origin[axis]);
      inverse_[axis].add(ray.inverse[axis]);
      room_[axis] = std::max(room_[axis], ray.room[axis]);
    }
    t_min = std::min(t_min, ray.t_min);
  }

  // A bound of how far the corners of a wide node's children are from all origins.
  float reach(const WideNode& node) const {
    float distance = 0;
    uint largest_step = 0;
    for (int axis = 0; axis < 3; ++axis) {
      distance = std::max({distance, std::fabs(node.origin[axis] - origin_[axis].low),
                           std::fabs(node.origin[axis] - origin_[axis].high)});
      largest_step = std::max(largest_step, step_bits(node, axis));
    }
    return distance + std::bit_cast<float>(largest_step) * WIDE_NODE_STEPS;
  }

  // For a box within `reach` of all origins.
  bool meets(const vec3& box_min, const vec3& box_max, float reach, float leave, float& enter) const {
    enter = t_min;
    for (int axis = 0; axis < 3; ++axis) {
      const Interval& inverse = inverse_[axis];
      const bool one_way = inverse.low > 0 || inverse.high < 0;
      if (!one_way || std::isinf(inverse.low) || std::isinf(inverse.high)) continue;
      const float below = box_min[axis] - origin_[axis].high, above = box_max[axis] - origin_[axis].low;
      const bool backward = inverse.high < 0;
      const float to_near = backward ? above : below, to_far = backward ? below : above;
      enter = std::max(enter, least_product(to_near, inverse) - room_[axis] * reach);
      leave = std::min(leave, -least_product(-to_far, inverse) + room_[axis] * reach);
    }
    return enter <= leave;
  }

  float t_min = infinity;

 private:
  Interval origin_[3], inverse_[3];
  float room_[3] = {};
};

struct Box {
  vec3 box_min, box_max;
};

Box child_box(const WideNode& node, uint child) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(node.planes) + 6 * child;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = std::bit_cast<float>(step_bits(node, axis));
    box.box_min[axis] = node.origin[axis] + static_cast<float>(bytes[axis]) * step;
    box.box_max[axis] = node.origin[axis] + static_cast<float>(bytes[axis + 3]) * step;
  }
  return box;
}

class Packet {
 public:
  explicit Packet(const TraceWideArgs& args) : args_(args) {}

  void add(const TraceRay& ray, const Sight& sight, const Hit& hit) {
    rays_.push_back(ray);
    sights_.push_back(sight);
    hits_.push_back(hit);
    bundle_.add(ray);
  }

  // Returns how many nodes it visits.
  uint trace() {
    if (rays_.empty() || !(bundle_.t_min <= farthest())) return 0;
    uint visited = 0;
    for (std::vector<uint> stack = {0}; !stack.empty(); ++visited) {
      const uint node = stack.back();
      stack.pop_back();
      const std::vector<uint> met = visit(args_.wide_nodes[node]);
      stack.insert(stack.end(), met.rbegin(), met.rend());
    }
    return visited;
  }

  const std::vector<TraceRay>& rays() const { return rays_; }
  const std::vector<Hit>& hits() const { return hits_; }

 private:
  float farthest() const { return std::ranges::max_element(hits_, {}, &Hit::t)->t; }

  bool any_meets(const Box& box, float reach) const {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      float enter;
      if (ray_meets_box_within(rays_[i], box.box_min, box.box_max, reach, hits_[i].t, enter)) return true;
    }
    return false;
  }

  // Tests the triangles among the children. The nodes among them that a ray meets, nearest first.
  std::vector<uint> visit(const WideNode& node) {
    struct Met {
      uint key, child;
    };
    std::vector<Met> met;
    const float reach = bundle_.reach(node);
    for (uint child = 0; child < WIDE_CHILDREN; ++child) {
      const Box box = child_box(node, child);
      float enter;
      if (node.child[child] != WIDE_EMPTY &&
          bundle_.meets(box.box_min, box.box_max, reach, farthest(), enter))
        met.push_back({(std::bit_cast<uint>(enter) & ~(WIDE_CHILDREN - 1)) | child, child});
    }
    std::ranges::sort(met, {}, &Met::key);
    std::vector<uint> nodes;
    for (const Met& next : met) {
      if (!any_meets(child_box(node, next.child), reach)) continue;
      const uint word = node.child[next.child], triangle = word & ~WIDE_LEAF;
      if (word < WIDE_LEAF) {
        nodes.push_back(word);
        continue;
      }
      for (std::size_t i = 0; i < rays_.size(); ++i)
        if (sights_[i].sees(triangle))
          ray_meets_triangle(rays_[i], args_.triangles[triangle], triangle, TRIANGLE_WATERTIGHT, hits_[i]);
    }
    return nodes;
  }

  const TraceWideArgs& args_;
  std::vector<TraceRay> rays_;
  std::vector<Sight> sights_;
  std::vector<Hit> hits_;
  Bundle bundle_;
};

// The rays from `first` on. Returns how many nodes they visit.
uint trace_packet(const TraceWideArgs& args, uint first, uint count) {
  Packet packet(args);
  std::vector<uint> indices;
  for (uint i = first; i < first + count; ++i) {
    TraceRay ray(args.rays[i]);
    if (!ray.is_sound) continue;
    const Node& root = args.nodes[0];
    ray.approach(root.box_min, root.box_max);
    packet.add(ray, Sight(args, i), ray.prepared(args.hits[i]));
    indices.push_back(i);
  }
  const uint visited = packet.trace();
  for (std::size_t k = 0; k < indices.size(); ++k)
    packet.rays()[k].keep(packet.hits()[k], args.hits[indices[k]]);
  return visited;
}

}  // namespace

void trace_wide(const TraceWideArgs& args) {
  TraceCounters& counters = args.counters[0];
  const uint ray_count = counted(args.count_at, args.ray_count);
  note_ray_count(args.state[0], args.count_at, args.ray_count);
  for (uint first = 0; first < ray_count; first += TRACE_PACKET) {
    const uint count = std::min(TRACE_PACKET, ray_count - first);
    const uint steps = args.wide_counts[0].node_count != 0 ? trace_packet(args, first, count) : 0;
    count_into(counters.steps, std::uint64_t{steps} * count);
    count_into(counters.rays, count);
    for (uint i = first; i < first + count; ++i) {
      count_into(counters.hits, args.hits[i].triangle != NO_TRIANGLE);
      keep_ray_steps(args, i, steps);
    }
  }
}

}  // namespace coppice::twins
