// In:  rays, marks and their prefix sums. Out: the marked rays one behind the other, see PathQueueArgs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/path.glsl"

layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { PathQueueArgs args; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.ray_count) return;
  uint mark = args.marks.at[i], place = args.places.at[i];
  if (i + 1u == args.ray_count) args.queued_count.at[0] = place + mark;
  if (mark == 0u) return;
  Ray ray = load_ray(args.marked_rays, i);
  store_ray(args.queued_rays, place, ray);
  if (uint64_t(args.marked_paths) == 0ul) return;
  args.queued_paths.at[place] = args.marked_paths.at[i];
  store_hit(args.queued_hits, place, Hit(ray.t_max, NO_TRIANGLE, 0.0, 0.0));
}
