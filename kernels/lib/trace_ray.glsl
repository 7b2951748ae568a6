// A ray made ready for the intersection tests: direction scaled by a power of two, tiny components cleared, a far
// origin moved close to the scene. The reasons and bounds are in docs/numerics.md, "Rays".
#ifndef COPPICE_LIB_TRACE_RAY
#define COPPICE_LIB_TRACE_RAY
#include "error_free.glsl"

const float NEGLIGIBLE_COMPONENT = 5.42101086242752217e-20;  // 2^-64, of a direction whose largest is in [1, 4)
const float FAR_ORIGIN = 16.0;                               // in scene sizes
const float FARTHEST_MOVE = 1.2676506002282294e30;           // 2^100: beyond it splitting overflows
const float BOX_ROOM = 1.430511474609375e-6;                 // 24 * 2^-24

struct TraceRay {
  vec3 origin;
  vec3 direction;
  float t_min;
  vec3 inverse;   // reciprocal of the direction, infinite with its sign where that is zero
  vec3 room;      // t by which the robust box test widens each slab, for a corner of the box one unit away
  uint axis;      // largest component of the direction
  vec3 shear;     // maps the direction to (0, 0, 1), axes in cyclic order with `axis` last
  float moved;    // t by which the origin was moved
  float scale;    // t counts in direction * scale
};

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// The largest component of two vectors by magnitude; integers compare in one instruction each on CPU devices.
float largest(vec3 v, vec3 w) {
  ivec3 bits = max(floatBitsToInt(abs(v)), floatBitsToInt(abs(w)));
  return intBitsToFloat(max(max(bits.x, bits.y), bits.z));
}

vec3 cyclic(vec3 v, uint last) { return last == 0u ? v.yzx : (last == 1u ? v.zxy : v); }

float reciprocal(float x) {
  if (x == 0.0) return uintBitsToFloat((floatBitsToUint(x) & 0x80000000u) | 0x7f800000u);
  return 1.0 / x;
}

float clear_negligible(float x) {
  return abs(x) < NEGLIGIBLE_COMPONENT ? uintBitsToFloat(floatBitsToUint(x) & 0x80000000u) : x;
}

// Some devices read denormals as zero, so all do.
float clear_denormal(float x) {
  uint bits = floatBitsToUint(x);
  return (bits & 0x7f800000u) == 0u ? uintBitsToFloat(bits & 0x80000000u) : x;
}

// False for a ray that hits nothing, see struct Ray.
bool prepare_ray(Ray ray, out TraceRay r) {
  float size = largest(ray.direction);
  bool is_sound = !any(isnan(ray.direction)) && !any(isnan(ray.origin)) && !isinf(size) && !isinf(largest(ray.origin)) &&
                  (floatBitsToUint(size) & 0x7f800000u) != 0u && ray.t_min <= ray.t_max;
  if (!is_sound) return false;
  uint exponent = max(floatBitsToUint(size) >> 23, 2u);
  r.scale = uintBitsToFloat((255u - exponent) << 23);
  vec3 normal = vec3(clear_denormal(ray.direction.x), clear_denormal(ray.direction.y), clear_denormal(ray.direction.z));
  precise vec3 direction = normal * r.scale;
  r.direction = vec3(clear_negligible(direction.x), clear_negligible(direction.y), clear_negligible(direction.z));
  precise float t_min = ray.t_min * uintBitsToFloat((exponent - 1u) << 23);
  r.t_min = t_min;
  r.origin = ray.origin;
  r.inverse = vec3(reciprocal(r.direction.x), reciprocal(r.direction.y), reciprocal(r.direction.z));
  vec3 d = abs(r.direction);
  r.axis = d.x >= d.y && d.x >= d.z ? 0u : (d.y >= d.z ? 1u : 2u);
  vec3 cycled = cyclic(r.direction, r.axis);
  precise vec3 shear = vec3(cycled.xy / cycled.z, 1.0 / cycled.z);
  r.shear = shear;
  r.moved = 0.0;
  precise vec3 room = abs(r.inverse) * BOX_ROOM;
  r.room = vec3(isinf(room.x) ? 0.0 : room.x, isinf(room.y) ? 0.0 : room.y, isinf(room.z) ? 0.0 : room.z);
  return true;
}

float along(float origin, float direction, float t) {
  vec2 way = two_product(direction, t);
  vec2 sum = two_sum(origin, way.x);
  precise float result = sum.x + (sum.y + way.y);
  return result;
}

vec3 reach_of(vec3 origin, Aabb box) {
  precise vec3 below = box.box_min - origin;
  precise vec3 above = box.box_max - origin;
  return max(abs(below), abs(above));
}

// Moves the origin of a ray that starts far away, along the ray to just before the scene's box.
void approach_scene(Aabb box, inout TraceRay r) {
  precise vec3 extent = box.box_max - box.box_min;
  float size = largest(extent);
  if (!(largest(reach_of(r.origin, box)) > FAR_ORIGIN * size)) return;
  precise vec3 to_centre = (box.box_min * 0.5 + box.box_max * 0.5) - r.origin;
  precise float t = cyclic(to_centre, r.axis).z * r.shear.z * (1.0 - 9.5367431640625e-7) - 2.0 * size;
  if (!(t > 0.0 && t < FARTHEST_MOVE)) return;
  r.origin = vec3(along(r.origin.x, r.direction.x, t), along(r.origin.y, r.direction.y, t),
                  along(r.origin.z, r.direction.z, t));
  precise float t_min = max(r.t_min - t, 0.0);
  r.t_min = t_min;
  r.moved = t;
}

// A hit of the ray as given, seen from the ray as prepared.
Hit prepared_hit(TraceRay r, Hit hit) {
  precise float t = hit.t * uintBitsToFloat(0x7f000000u - floatBitsToUint(r.scale)) - r.moved;
  return Hit(t, hit.triangle, hit.u, hit.v);
}

// Whether the t of a hit of the prepared ray is one of the ray as given: beyond the range of float there is no hit.
bool is_given(TraceRay r, Hit hit) {
  precise float t = (hit.t + r.moved) * r.scale;
  return !isinf(t);
}

// Replaces `so_far` by a new hit of the prepared ray. The rounding of t must not carry it out of the given range; a t
// beyond the range of float is no hit.
void keep_given(TraceRay r, Ray given, Hit hit, inout Hit so_far) {
  if (hit.triangle == so_far.triangle) return;
  precise float t = (hit.t + r.moved) * r.scale;
  if (!isinf(t)) so_far = Hit(clamp(t, given.t_min, so_far.t), hit.triangle, hit.u, hit.v);
}

#endif
