// Rays and hits read and written as words of 64 bits: devices that load a vector lane by lane take half as long.
#ifndef COPPICE_LIB_RAY_WORDS
#define COPPICE_LIB_RAY_WORDS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RayWordsBuffer { u64vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer HitWordsBuffer { u64vec2 at[]; };

Ray load_ray(RayBuffer rays, uint i) {
  u64vec4 words = RayWordsBuffer(rays).at[i];
  vec2 a = uintBitsToFloat(unpackUint2x32(words.x)), b = uintBitsToFloat(unpackUint2x32(words.y));
  vec2 c = uintBitsToFloat(unpackUint2x32(words.z)), d = uintBitsToFloat(unpackUint2x32(words.w));
  return Ray(vec3(a, b.x), b.y, vec3(c, d.x), d.y);
}

void store_ray(RayBuffer rays, uint i, Ray ray) {
  uvec4 from = floatBitsToUint(vec4(ray.origin, ray.t_min)), to = floatBitsToUint(vec4(ray.direction, ray.t_max));
  RayWordsBuffer(rays).at[i] =
      u64vec4(packUint2x32(from.xy), packUint2x32(from.zw), packUint2x32(to.xy), packUint2x32(to.zw));
}

Hit load_hit(HitBuffer hits, uint i) {
  u64vec2 words = HitWordsBuffer(hits).at[i];
  uvec2 a = unpackUint2x32(words.x), b = unpackUint2x32(words.y);
  return Hit(uintBitsToFloat(a.x), a.y, uintBitsToFloat(b.x), uintBitsToFloat(b.y));
}

void store_hit(HitBuffer hits, uint i, Hit hit) {
  HitWordsBuffer(hits).at[i] = u64vec2(packUint2x32(uvec2(floatBitsToUint(hit.t), hit.triangle)),
                                       packUint2x32(floatBitsToUint(vec2(hit.u, hit.v))));
}

#endif
