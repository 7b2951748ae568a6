// The main of trace_wide_any and trace_wide_any_alpha, which have `args` before.
layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // as in trace_closest
layout(constant_id = 1) const bool TRACE_MASKED = true;            // as in trace_closest
const bool TRACE_COUNTS_RAYS = false;

#define SEARCH Search(true, TRACE_MASKED)
#include "wide_block.glsl"

Hit hit_so_far(uint ray, Ray given) { return Hit(given.t_max, NO_TRIANGLE, 0.0, 0.0); }

bool keep_hit(Walk w) {
  bool hits = w.hit.triangle != NO_TRIANGLE;
  args.any_hits.at[w.ray_index] = hits ? 1u : 0u;
  return hits;
}

bool keep_miss(uint ray, Hit so_far) {
  args.any_hits.at[ray] = 0u;
  return false;
}

void keep_steps(uint ray, uint steps) {}

void main() { trace_block(); }
