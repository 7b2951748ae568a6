// Takes a ray through two levels of BVH2, depth-first, the nearer child first: a tree over instances, and from each of
// its leaves the tree of the instance's mesh, by the ray as that mesh sees it. Leaves wait on the stack as pairs of
// children do, and are left out if the closest hit is before them when their turn comes. Needs the constants
// TRACE_MAX_TURNS and TRACE_STACK, and TRACE_TRIANGLE_TEST and TRACE_BOX_TEST as watertight and robust.
#ifndef COPPICE_LIB_WALK_INSTANCES
#define COPPICE_LIB_WALK_INSTANCES
#include "instance.glsl"
#include "intersect_box.glsl"
#include "intersect_triangle.glsl"
#include "node_words.glsl"
#include "trace_ray.glsl"
#include "triangle_words.glsl"

struct TwoLevels {
  NodeBuffer nodes;  // over the instances
  NodeBuffer mesh_nodes;
  TriangleBuffer mesh_triangles;
  MeshRangeBuffer meshes;
  PlacedInstanceBuffer placed;
  InstanceTransformBuffer transforms;
};

// The ray as the boxes of one level see it: slabs are widened by `room` for each unit that the box reaches, and `pad`.
struct Level {
  vec3 origin, inverse, room, pad;
};

struct InstanceHit {
  Hit hit;
  uint instance;
};

// What to visit: the first of a pair of children, or a leaf's child.
const uint VISIT_LEAF = 0x80000000u;
const uint NO_VISIT = 0xffffffffu;

struct InstanceWalk {
  uint visit;
  uint top;       // of the stack
  uint base;      // where the stack of the mesh's tree begins
  uint instance;  // whose mesh is walked; NO_INSTANCE above
  uint64_t nodes; // of the tree that is walked
  uint first_triangle;
  uint steps;
};

uint stack_visit[TRACE_STACK];
float stack_enter[TRACE_STACK];

Level world_level(TraceRay ray) { return Level(ray.origin, ray.inverse, ray.room, vec3(0.0)); }

// So that no component of the direction is 0; what that moves the ray by is in the room.
float kept_away_from_zero(float component, float room) {
  float least = room * INSTANCE_CLAMP;
  if (abs(component) < least) return component < 0.0 ? -least : least;
  return component;
}

Level mesh_level(TraceRay ray, PlacedInstance placed, Transform by) {
  precise vec3 way = ray.origin - vec3(by.rows[0].w, by.rows[1].w, by.rows[2].w);
  float distance = largest(way);
  vec3 room = vec3(placed.room_x, placed.room_y, placed.room_z);
  precise vec3 pad = room * distance + placed.pad;
  if (!(distance <= INSTANCE_HIGH)) pad = vec3(uintBitsToFloat(0x7f800000u));
  Level level;
  level.origin = vec3(exact_dot(placed.row_x, way), exact_dot(placed.row_y, way), exact_dot(placed.row_z, way));
  vec3 direction = vec3(kept_away_from_zero(exact_dot(placed.row_x, ray.direction), room.x),
                        kept_away_from_zero(exact_dot(placed.row_y, ray.direction), room.y),
                        kept_away_from_zero(exact_dot(placed.row_z, ray.direction), room.z));
  level.inverse = 1.0 / direction;
  precise vec3 pad_in_t = pad * abs(level.inverse);
  precise vec3 room_in_t = abs(level.inverse) * BOX_ROOM;
  level.pad = pad_in_t;
  level.room = room_in_t;
  return level;
}

bool meets_box(Level level, Node node, float leave, inout float enter) {
  precise vec3 to_min = node.box_min - level.origin;
  precise vec3 to_max = node.box_max - level.origin;
  float reach = largest(to_min, to_max);
  precise vec3 pad = level.room * reach + level.pad;
  clip_to_slab(node.box_min.x, node.box_max.x, level.origin.x, level.inverse.x, pad.x, enter, leave);
  clip_to_slab(node.box_min.y, node.box_max.y, level.origin.y, level.inverse.y, pad.y, enter, leave);
  clip_to_slab(node.box_min.z, node.box_max.z, level.origin.z, level.inverse.z, pad.z, enter, leave);
  return enter <= leave;
}

uint visit_of(Node node) { return node.height == 0u ? node.child | VISIT_LEAF : node.child; }

void visit_root(Level level, float t_min, float t, inout InstanceWalk walk) {
  Node root = load_node(NodeBuffer(walk.nodes), 0u);
  float enter = t_min;
  walk.visit = meets_box(level, root, t, enter) ? visit_of(root) : NO_VISIT;
}

void visit_pair(Level level, float t_min, float t, inout InstanceWalk walk) {
  Node left = load_node(NodeBuffer(walk.nodes), walk.visit);
  Node right = load_node(NodeBuffer(walk.nodes), walk.visit + 1u);
  float left_enter = t_min, right_enter = t_min;
  bool go_left = meets_box(level, left, t, left_enter);
  bool go_right = meets_box(level, right, t, right_enter);
  ++walk.steps;
  bool left_first = left_enter <= right_enter;
  if (go_left && go_right) {
    stack_visit[walk.top] = visit_of(left_first ? right : left);
    stack_enter[walk.top] = left_first ? right_enter : left_enter;
    ++walk.top;
  }
  bool goes = go_left || go_right;
  walk.visit = goes ? visit_of(go_left && (left_first || !go_right) ? left : right) : NO_VISIT;
}

void enter_mesh(TwoLevels levels, TraceRay ray, float t, inout InstanceWalk walk, out Level level) {
  uint instance = walk.visit & ~VISIT_LEAF;
  PlacedInstance placed = load_placed(levels.placed, instance);
  MeshRange mesh = levels.meshes.at[placed.mesh];
  level = mesh_level(ray, placed, load_transform(levels.transforms, instance));
  walk.instance = instance;
  walk.base = walk.top;
  walk.first_triangle = mesh.first_triangle;
  walk.nodes = uint64_t(levels.mesh_nodes) + uint64_t(mesh.first_node) * 32u;
  visit_root(level, ray.t_min, t, walk);
}

void leave_mesh(TwoLevels levels, TraceRay ray, inout InstanceWalk walk, out Level level) {
  level = world_level(ray);
  walk.instance = NO_INSTANCE;
  walk.nodes = uint64_t(levels.nodes);
}

// A tie goes to the smaller instance: against a greater one every triangle wins it, against a smaller one none.
void test_triangle(TwoLevels levels, TraceRay ray, InstanceWalk walk, inout InstanceHit closest) {
  uint index = walk.visit & ~VISIT_LEAF;
  Triangle mesh = load_triangle(levels.mesh_triangles, walk.first_triangle + index);
  Transform by = load_transform(levels.transforms, walk.instance);
  Triangle triangle = Triangle(transformed(by, mesh.a), transformed(by, mesh.b), transformed(by, mesh.c));
  if (!(finite(triangle.a) && finite(triangle.b) && finite(triangle.c))) return;
  uint rank = walk.instance == closest.instance ? closest.hit.triangle : 0u;
  if (walk.instance < closest.instance) rank = NO_TRIANGLE;
  Hit hit = Hit(closest.hit.t, rank, 0.0, 0.0);
  intersect_triangle(ray, triangle, index, hit);
  if (hit.t != closest.hit.t || hit.triangle != rank) closest = InstanceHit(hit, walk.instance);
}

bool is_unfinished(InstanceWalk walk) { return walk.visit != NO_VISIT || walk.top != 0u; }

// Improves `closest`. The walk still goes on if it needs more turns than it may take.
InstanceWalk walk_instances(TwoLevels levels, TraceRay ray, inout InstanceHit closest) {
  InstanceWalk walk = InstanceWalk(NO_VISIT, 0u, 0u, NO_INSTANCE, uint64_t(levels.nodes), 0u, 0u);
  Level level = world_level(ray);
  visit_root(level, ray.t_min, closest.hit.t, walk);
  uint turns = 0u;
  [[dont_unroll]] while (turns < TRACE_MAX_TURNS && is_unfinished(walk)) {
    ++turns;
    if (walk.visit == NO_VISIT) {
      if (walk.instance != NO_INSTANCE && walk.top == walk.base) leave_mesh(levels, ray, walk, level);
      --walk.top;
      if (stack_enter[walk.top] <= closest.hit.t) walk.visit = stack_visit[walk.top];
    }
    if ((walk.visit & VISIT_LEAF) == 0u) visit_pair(level, ray.t_min, closest.hit.t, walk);
    if ((walk.visit & VISIT_LEAF) != 0u && walk.visit != NO_VISIT) {
      if (walk.instance == NO_INSTANCE) {
        enter_mesh(levels, ray, closest.hit.t, walk, level);
      } else {
        test_triangle(levels, ray, walk, closest);
        walk.visit = NO_VISIT;
      }
    }
  }
  return walk;
}

#endif
