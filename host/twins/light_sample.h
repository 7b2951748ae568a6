#pragma once

#include <optional>

#include "interface/paths.h"

namespace coppice::twins {

// What lights are chosen from, by any stage of paths.
struct LightTables {
  Address<const Triangle> triangles;
  Address<const LightSource> lights;
  Address<const LightChoice> choices;
  uint choice_count;
  Address<const Surrounding> surroundings;
};

template <class Args>
LightTables light_tables(const Args& args) {
  return {args.triangles, args.lights, args.choices, args.choice_count, args.surroundings};
}

struct SampledLight {
  vec3 towards;   // from the point, not of unit length
  float t_max;    // in units of it
  vec3 radiance;  // by the density
  float pdf;      // by solid angle; 0 where no path meets it
};

// `u`: a multiple of 2^-24 in [0, 1).
const LightChoice& choice_for(const LightTables& tables, float u);

// For a point; none where it gets nothing from there. The numbers are those of the contract in
// kernels/interface/paths.h: `u` places it on an emitter or chooses a texel, `in_texel` a place in that.
std::optional<SampledLight> sample_choice(const LightTables& tables, const LightChoice& choice,
                                          const vec3& origin, const glm::vec2& u, const glm::vec2& in_texel);

}  // namespace coppice::twins
