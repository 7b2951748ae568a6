// Directions that lib/bsdf.glsl samples. Polynomials for cosine and sine, see docs/numerics.md.
#ifndef COPPICE_LIB_BSDF_DIRECTIONS
#define COPPICE_LIB_BSDF_DIRECTIONS
#include "lib/disk_point.glsl"
#include "lib/exact_vector.glsl"
#include "lib/turn.glsl"

struct BsdfFrame {
  vec3 tangent, bitangent;
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
BsdfFrame bsdf_frame(vec3 normal) {
  float side = normal.z < 0.0 ? -1.0 : 1.0;
  precise float a = -1.0 / (side + normal.z);
  precise float b = normal.x * normal.y * a;
  precise vec3 tangent = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  precise vec3 bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
  return BsdfFrame(tangent, bitangent);
}

// (x, y) of the frame and z of the normal; of unit length.
vec3 bsdf_from_frame(vec3 normal, BsdfFrame frame, vec3 v) {
  precise vec3 direction = frame.tangent * v.x + frame.bitangent * v.y + normal * v.z;
  return unit(direction);
}

// By the cosine to the normal: a point of the disk, lifted to the hemisphere. For u in multiples of 2^-24 the cosine is
// at least 2^-11.5.
vec3 bsdf_diffuse_direction(vec3 normal, vec2 u) {
  vec3 disk = disk_point(u);
  precise float height = sqrt(max((1.0 - disk.z) * (1.0 + disk.z), 0.0));
  return bsdf_from_frame(normal, bsdf_frame(normal), vec3(disk.xy, height));
}

// The normal of a facet as the view sees facets; unit, on the side of the normal.
vec3 bsdf_visible_facet(vec3 normal, vec3 view, float alpha, vec2 u) {
  BsdfFrame frame = bsdf_frame(normal);
  precise vec3 stretched =
      vec3(alpha * exact_dot(frame.tangent, view), alpha * exact_dot(frame.bitangent, view), exact_dot(normal, view));
  vec3 from = unit(stretched);
  // A point of the cap from the pole down to -from.z, plus `from`: its height is 1 - fall.
  precise float fall = u.y * (1.0 + from.z);
  precise float radius = sqrt(max(fall * (2.0 - fall), 0.0));
  vec2 around = turn(u.x);
  precise vec3 facet = vec3(alpha * (radius * around.x + from.x), alpha * (radius * around.y + from.y),
                            (1.0 - u.y) * (1.0 + from.z));
  return bsdf_from_frame(normal, frame, facet);
}

vec3 bsdf_mirrored(vec3 view, vec3 normal, float cosine) {
  precise vec3 direction = normal * (2.0 * cosine) - view;
  return unit(direction);
}

// Snell's law; `refracted` is the cosine on the other side. Without change of medium straight on.
vec3 bsdf_refracted(vec3 view, vec3 normal, float cosine, float refracted, float ior_ratio) {
  if (ior_ratio == 1.0) return -view;
  precise vec3 direction = normal * (ior_ratio * cosine - refracted) - view * ior_ratio;
  return unit(direction);
}

#endif
