#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/paths.h"
#include "scene/effect_set.h"

namespace coppice {

// What the stages of paths take of a scene.
struct PathArrays {
  PathCounts counts;                         // not any(): the scene calls for none, all is empty
  std::vector<SurfaceMaterial> materials;    // emission and base colour
  std::vector<PathMaterial> path_materials;  // one a material, as above
  std::vector<Surrounding> surroundings;     // see interface/environment.h
  std::vector<LightSource> lights;           // those that are listed
  std::vector<LightChoice> choices;          // to choose a light from
  std::vector<float> emitter_probability;    // one a triangle; empty without emitters
  std::vector<std::string> warnings;         // of an environment whose image is missing or broken
};

// `triangles`: those of the scene as the stages take them. Throws InputError for more than MAX_EMITTERS.
PathArrays path_arrays(const Scene& scene, const EffectSet& effects, std::span<const Triangle> triangles);

inline constexpr std::size_t MAX_EMITTERS = 1u << 22;

}  // namespace coppice
