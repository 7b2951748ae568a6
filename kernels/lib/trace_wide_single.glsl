// The main of trace_wide_single and trace_wide_single_alpha, which have `args` before.
layout(local_size_x_id = DEVICE_SUBGROUP_SIZE_ID) in;
layout(constant_id = 0) const uint TRACE_MAX_TURNS = 0xffffffffu;  // as in trace_closest
layout(constant_id = 1) const bool TRACE_MASKED = true;            // as in trace_closest
layout(constant_id = 2) const bool TRACE_COUNTS_RAYS = false;      // the steps of each are kept

#define SEARCH Search(false, TRACE_MASKED)
#include "wide_block.glsl"

Hit hit_so_far(uint ray, Ray given) { return load_hit(args.hits, ray); }

bool keep_hit(Walk w) {
  Hit so_far = load_hit(args.hits, w.ray_index);
  keep_given(w.ray, load_ray(args.rays, w.ray_index), w.hit, so_far);
  store_hit(args.hits, w.ray_index, so_far);
  return so_far.triangle != NO_TRIANGLE;
}

bool keep_miss(uint ray, Hit so_far) { return so_far.triangle != NO_TRIANGLE; }

void keep_steps(uint ray, uint steps) { args.ray_steps.at[ray] = steps; }

void main() { trace_block(); }
