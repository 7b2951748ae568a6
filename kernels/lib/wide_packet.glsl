// A packet of rays that walks through a wide tree together: Wald, Slusallek, Benthin and Wagner 2001, "Interactive Rendering
// with Coherent Ray Tracing". A subgroup is a packet, several rays an invocation, with one stack. A node is read once for
// all of them; its children are tested an invocation each against the bundle of all rays, and those that it meets,
// nearest first, against every ray. So this is for rays that begin close to each other and go the same way.
//
// Needs `args` and the constant TRACE_MAX_TURNS, and after it the function below.
#include "count_error.glsl"
#include "search.glsl"
#include "trace_counters.glsl"
#include "trace_ray.glsl"

// Whether the r-th ray of this invocation sees the triangle.
bool packet_sees(uint r, uint triangle);
#ifdef TRACE_ALPHA
// Whether it passes the triangle that it hits.
bool packet_passes(uint r, Hit hit);
#endif

const uint TRACE_TRIANGLE_TEST = TRIANGLE_WATERTIGHT;
const uint TRACE_BOX_TEST = BOX_ROBUST;

#include "intersect_box.glsl"
#include "intersect_triangle.glsl"
#include "packet.glsl"
#include "ray_bundle.glsl"
#include "wide_children.glsl"

const uint RAYS = (TRACE_PACKET + LANES - 1u) / LANES;  // of an invocation

TraceRay rays[RAYS];
Hit hits[RAYS];
uint turns = 0u;

shared uvec2 stack[WIDE_MAX_HEIGHT];  // node, and its children still to be visited

// Children to be visited are nibbles of a word, the next one lowest.
const uint LISTED = 8u;  // the rest is the child's number

float farthest_hit() {
  float t = hits[0].t;
  [[unroll]] for (uint r = 1u; r < RAYS; ++r) t = greater(t, hits[r].t);
  return packet_greater(t);
}

// The children that the bundle meets, nearest first.
uint list_met(WideChildren children, RayBundle bundle, float reach, float farthest) {
  uint key[SLOTS];
  [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) {
    float enter;
    bool met = bundle_meets_box(bundle, children.box_min[slot], children.box_max[slot], reach, farthest, enter);
    met = met && children.word[slot] != WIDE_EMPTY;
    key[slot] = met ? (floatBitsToUint(enter) & ~(WIDE_CHILDREN - 1u)) | held_child(slot) : 0xffffffffu;
  }
  uint rank[SLOTS], list = 0u;
  [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) rank[slot] = 0u;
  [[unroll]] for (uint child = 0u; child < WIDE_CHILDREN; ++child) {
    uint other = of_child(key, child);
    [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) rank[slot] += other < key[slot] ? 1u : 0u;
  }
  // Where several invocations hold the same child the first one counts: the keys of the others may differ by a zero's
  // sign.
  bool counts = lane() < WIDE_CHILDREN;
  [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot)
    list |= counts && key[slot] != 0xffffffffu ? (LISTED | held_child(slot)) << (4u * rank[slot]) : 0u;
  return packet_or(list);
}

bool meets_box(uint r, vec3 box_min, vec3 box_max, float reach) {
  float enter = rays[r].t_min;
  return intersect_box_within(rays[r], box_min, box_max, reach, hits[r].t, enter);
}

// Bit r: the r-th ray of some invocation meets the box. Of a node one such ray is enough: the others are tested only if
// none of the first ones does.
uint meet_box(vec3 box_min, vec3 box_max, float reach, bool is_leaf) {
  const uint first = RAYS / 2u;
  uint meeting = meets_box(first, box_min, box_max, reach) ? 1u << first : 0u;
  if (is_leaf || !subgroupAny(meeting != 0u)) {
    [[unroll]] for (uint r = 0u; r < RAYS; ++r)
      if (r != first && meets_box(r, box_min, box_max, reach)) meeting |= 1u << r;
  }
  return packet_or(meeting);
}

const uint TRIANGLE_WORDS = 9u;
const uint TRIANGLE_LOADS = (TRIANGLE_WORDS + LANES - 1u) / LANES;

float triangle_word(uint words[TRIANGLE_LOADS], uint word) {
  return uintBitsToFloat(subgroupBroadcast(words[word / LANES], word % LANES));
}

vec3 corner(uint words[TRIANGLE_LOADS], uint word) {
  return vec3(triangle_word(words, word), triangle_word(words, word + 1u), triangle_word(words, word + 2u));
}

// An invocation a word: CPU devices read nine words of one triangle as slowly as those of as many triangles.
Triangle read_triangle(uint triangle) {
  UintBuffer at = UintBuffer(args.triangles);
  uint words[TRIANGLE_LOADS];
  [[unroll]] for (uint load = 0u; load < TRIANGLE_LOADS; ++load) {
    uint word = lane() + load * LANES;
    words[load] = at.at[triangle * TRIANGLE_WORDS + (word < TRIANGLE_WORDS ? word : 0u)];
  }
  return Triangle(corner(words, 0u), corner(words, 3u), corner(words, 6u));
}

// Tests the triangles among the children, and lists the nodes among them that a ray meets, nearest first.
uint visit(WideChildren children, RayBundle bundle, inout float farthest) {
  precise float reach = bundle_reach(bundle, children.origin) + children.size;
  uint met = list_met(children, bundle, reach, farthest);
  uint list = 0u, end = 0u;
  [[dont_unroll]] while (met != 0u) {
    ++turns;
    uint child = met & (WIDE_CHILDREN - 1u);
    met >>= 4;
    uint word = of_child(children.word, child);
    uint meeting =
        meet_box(of_child(children.box_min, child), of_child(children.box_max, child), reach, word >= WIDE_LEAF);
    if (meeting != 0u) {
      if (word >= WIDE_LEAF) {
        uint index = word & ~WIDE_LEAF;
        Triangle triangle = read_triangle(index);
        [[unroll]] for (uint r = 0u; r < RAYS; ++r) {
          if ((meeting >> r & 1u) == 0u) continue;
          if (!packet_sees(r, index)) continue;
#ifdef TRACE_ALPHA
          Hit before = hits[r];
#endif
          intersect_triangle(rays[r], triangle, index, hits[r]);
#ifdef TRACE_ALPHA
          if (hits[r].triangle != before.triangle && packet_passes(r, hits[r])) hits[r] = before;
#endif
        }
        farthest = farthest_hit();
      } else {
        list |= (LISTED | child) << end;
        end += 4u;
      }
    }
  }
  return list;
}

// Returns how many nodes the packet visits.
uint trace(RayBundle bundle) {
  float farthest = farthest_hit();
  uint node = 0u, next = 0u, list = 0u, top = 0u, visited = 0u;
  bool going = bundle.t_min <= farthest;
  [[dont_unroll]] while (going && turns < TRACE_MAX_TURNS) {
    ++turns;
    ++visited;
    if (list != 0u) {
      sync();
      if (lane() == 0u) stack[top] = uvec2(node, list);
      ++top;
    }
    node = next;
    WideChildren children;
    read_children(node, children);
    list = visit(children, bundle, farthest);
    if (list == 0u && top != 0u) {
      sync();
      --top;
      node = stack[top].x;
      list = stack[top].y;
      [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) children.word[slot] = read_child_word(node, slot);
    }
    going = list != 0u;
    next = of_child(children.word, list & (WIDE_CHILDREN - 1u));
    list >>= 4;
  }
  if (going && turns >= TRACE_MAX_TURNS) atomicOr(args.state.at[0].error_word, ERROR_TRACE_STEPS);
  return visited;
}

// A ray that hits nothing gets an empty range, and takes no part in the bundle.
void leave_out(uint r) {
  rays[r].t_min = uintBitsToFloat(0x7f800000u);
  hits[r] = Hit(-rays[r].t_min, NO_TRIANGLE, 0.0, 0.0);
}
