// A picture in 40 lines: what each pixel sees, and whether the sun sees it too.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "coppice/traverse.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
  CoppiceTree tree;  // four addresses of the tree's buffers
  UintBuffer image;  // RGBA8
  uint width, height;
  vec3 eye, corner, right, down;  // a pixel's direction is corner + x * right + y * down
};

const vec3 TO_SUN = vec3(0.36, 0.8, 0.48);

vec3 seen(Ray ray) {
  Hit hit = coppice_trace_closest(tree, ray, PRIMITIVE_MASK);
  if (hit.triangle == NO_TRIANGLE) return vec3(0.6, 0.8, 1.0);
  Triangle at = tree.triangles.at[hit.triangle];
  vec3 normal = normalize(cross(at.b - at.a, at.c - at.a));
  if (dot(normal, ray.direction) > 0.0) normal = -normal;
  vec3 point = at.a + hit.u * (at.b - at.a) + hit.v * (at.c - at.a);
  Ray shadow = Ray(point + normal * 1e-4 * length(point - eye), 0.0, TO_SUN, uintBitsToFloat(0x7f800000u));
  float light = max(dot(normal, TO_SUN), 0.0);
  if (light > 0.0 && coppice_trace_any(tree, shadow, PRIMITIVE_MASK)) light = 0.0;
  return vec3(0.2 + 0.8 * light);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= width || pixel.y >= height) return;
  vec3 direction = corner + (float(pixel.x) + 0.5) * right + (float(pixel.y) + 0.5) * down;
  vec3 colour = seen(Ray(eye, 0.0, direction, uintBitsToFloat(0x7f800000u)));
  image.at[pixel.y * width + pixel.x] = packUnorm4x8(vec4(colour, 1.0));
}
