#include "render/path_arrays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "render/environment_map.h"
#include "render/scene_arrays.h"
#include "render/stage_values.h"
#include "scene/input_error.h"
#include "scene/surface_effects.h"

namespace coppice {

namespace {

constexpr float brightest = 0x1p60f;
constexpr float mirror_shininess = 1000;  // Ns, from which on a reflection is sharp
constexpr float absent_shininess = 1;     // what a material without Ns has, whose reflection is sharp, too

double luminance(const vec3& colour) { return 0.2126 * colour.x + 0.7152 * colour.y + 0.0722 * colour.z; }

// 0 of a triangle without a place, which no ray hits.
double area_of(const Triangle& triangle) {
  const auto wide = [](const vec3& v) { return glm::dvec3(v.x, v.y, v.z); };
  const double area =
      0.5 * glm::length(glm::cross(wide(triangle.b) - wide(triangle.a), wide(triangle.c) - wide(triangle.a)));
  return std::isfinite(area) ? area : 0;
}

// alpha of GGX of a highlight as wide as Phong's: Walter et al. 2007; roughness is its root.
float roughness_of(const Material& material) {
  if (material.roughness) return *material.roughness;
  if (material.shininess <= absent_shininess || material.shininess >= mirror_shininess) return 0;
  return std::sqrt(std::sqrt(2 / (material.shininess + 2)));
}

float normal_reflectance(float ior) {
  const float ratio = (ior - 1) / (ior + 1);
  return ratio * ratio;
}

// Where it is no metal.
vec3 specular_of(const Material& material) {
  const float ior = material.index_of_refraction;
  if (material.roughness || material.metallic) return vec3(normal_reflectance(ior == 1 ? 1.5f : ior));
  if (material.illum < 3 || material.illum > 7) return vec3(0);
  const bool fresnel = material.illum == 5 || material.illum == 7;
  return fresnel && ior != 1 ? vec3(normal_reflectance(ior)) : material.specular;
}

PathMaterial path_material(const Material& material, const EffectSet& effects) {
  PathMaterial result{};
  result.ior = glm::clamp(material.index_of_refraction, 1 / 16.0f, 16.0f);
  result.filter_colour = flush_to_zero(glm::clamp(material.filter, 0.0f, 1.0f));
  result.roughness = roughness_of(material);
  if (effects.has(Effect::reflection)) {
    result.specular = flush_to_zero(glm::clamp(specular_of(material), 0.0f, 1.0f));
    result.metallic = metalness_of(material);
  }
  if (effects.has(Effect::refraction)) result.transmission = transmission_of(material);
  return result;
}

// Sources and how bright each is beside the others of its kind.
struct Weighed {
  std::vector<LightChoice> choices;
  std::vector<double> weights;

  void add(const LightChoice& choice, double weight) {
    if (!(weight > 0 && std::isfinite(weight))) return;
    choices.push_back(choice);
    weights.push_back(weight);
  }
};

// Shares of `range` by weight, each at least 1: cumulated ends behind those that are there.
void share_out(const Weighed& kind, uint range, std::vector<LightChoice>& choices) {
  double all = 0;
  for (const double weight : kind.weights) all += weight;
  const auto count = static_cast<uint>(kind.choices.size());
  const uint first = choices.empty() ? 0 : choices.back().end;
  double until = 0;
  uint end = first;
  for (uint i = 0; i < count; ++i) {
    until += kind.weights[i];
    const auto share = static_cast<uint>(std::min(until / all, 1.0) * (range - count));
    const uint own_end = i + 1 == count ? first + range : first + share + i + 1;
    LightChoice choice = kind.choices[i];
    choice.probability = static_cast<float>(own_end - end) / static_cast<float>(LIGHT_CHOICE_RANGE);
    choice.end = end = own_end;
    choices.push_back(choice);
  }
}

Weighed emitters_of(const Scene& scene, std::span<const Triangle> triangles, bool shadows) {
  Weighed emitters;
  for (uint i = 0; i < triangles.size(); ++i) {
    const Material& material = scene.materials[scene.material_index[i]];
    if (!is_emitter(material)) continue;
    const vec3 emission = flush_to_zero(glm::clamp(material.emission, 0.0f, brightest));
    emitters.add(
        {.source = i, .probability = 0, .end = 0, .shadows = shadows, .emission = emission, .padding = 0},
        luminance(emission) * area_of(triangles[i]));
  }
  if (emitters.choices.size() > MAX_EMITTERS)
    throw InputError("scene '" + scene.name + "' has " + std::to_string(emitters.choices.size()) +
                     " triangles that emit light, at most " + std::to_string(MAX_EMITTERS) +
                     " are taken (--effects=-emission goes without)");
  return emitters;
}

Weighed listed_lights(const Scene& scene, const EffectSet& effects, std::vector<LightSource>& sources) {
  Weighed listed;
  for (const Light& light : path_lights(scene, effects)) {
    const auto index = static_cast<uint>(sources.size());
    sources.push_back(light_source(light));
    listed.add({.source = LIGHT_CHOICE_LISTED | index,
                .probability = 0,
                .end = 0,
                .shadows = light.shadows,
                .emission = vec3(0),
                .padding = 0},
               std::min<double>(luminance(light.radiance), brightest));
  }
  return listed;
}

// One choice, where it has light.
Weighed environment_of(const EnvironmentMap& map, bool shadows) {
  Weighed environment;
  if (is_bright(map))
    environment.add({.source = LIGHT_CHOICE_ENVIRONMENT,
                     .probability = 0,
                     .end = 0,
                     .shadows = shadows,
                     .emission = vec3(0),
                     .padding = 0},
                    1);
  return environment;
}

// Kinds of lights have the same share each, the last one what is over.
void share_out(std::span<const Weighed* const> kinds, std::vector<LightChoice>& choices) {
  const auto count = static_cast<uint>(
      std::ranges::count_if(kinds, [](const Weighed* kind) { return !kind->choices.empty(); }));
  uint to_come = count;
  for (const Weighed* const kind : kinds) {
    if (kind->choices.empty()) continue;
    const uint so_far = choices.empty() ? 0 : choices.back().end;
    share_out(*kind, --to_come == 0 ? LIGHT_CHOICE_RANGE - so_far : LIGHT_CHOICE_RANGE / count, choices);
  }
}

void add_choices(const Scene& scene, const EffectSet& effects, std::span<const Triangle> triangles,
                 const EnvironmentMap& map, PathArrays& arrays) {
  const bool shadows = effects.has(Effect::shadows);
  const Weighed listed = listed_lights(scene, effects, arrays.lights);
  const Weighed emitters = effects.has(Effect::emission) ? emitters_of(scene, triangles, shadows) : Weighed{};
  const Weighed environment = environment_of(map, shadows);
  const Weighed* const kinds[] = {&listed, &emitters, &environment};
  share_out(kinds, arrays.choices);
  if (!emitters.choices.empty()) {
    arrays.emitter_probability.assign(triangles.size(), 0);
    for (const LightChoice& choice : arrays.choices) {
      if ((choice.source & LIGHT_CHOICE_LISTED) == 0)
        arrays.emitter_probability[choice.source] = choice.probability;
    }
  }
  PathCounts& counts = arrays.counts;
  counts.choices = static_cast<uint>(arrays.choices.size());
  counts.lights = static_cast<uint>(arrays.lights.size());
  counts.emitters = !emitters.choices.empty();
  counts.shadows = std::ranges::any_of(arrays.choices, [](const LightChoice& c) { return c.shadows != 0; });
}

// Behind the map, see interface/fog.h.
void add_fog(const Fog& fog, std::span<const Triangle> triangles, PathArrays& arrays) {
  const Aabb all = box_of(triangles);
  const FogBox box = fog.box.value_or(FogBox{all.box_min, all.box_max});
  arrays.surroundings.push_back({flush_to_zero(box.min), std::bit_cast<uint>(fog.density)});
  arrays.surroundings.push_back({flush_to_zero(box.max), std::bit_cast<uint>(fog.anisotropy)});
  arrays.surroundings.push_back({flush_to_zero(glm::clamp(fog.albedo, 0.0f, 1.0f)), 0});
  arrays.counts.fog = true;
}

// With an environment ambient light has no place.
void add_surroundings(const Scene& scene, const EnvironmentMap& map, PathArrays& arrays) {
  const auto chosen = std::ranges::find(arrays.choices, LIGHT_CHOICE_ENVIRONMENT, &LightChoice::source);
  const float probability = chosen == arrays.choices.end() ? 0 : chosen->probability;
  const vec3 ambient = map.side > 0 ? vec3(0) : flush_to_zero(scene.ambient_light);
  arrays.surroundings = surroundings(ambient, map, probability);
  arrays.counts.environment_side = map.side;
}

}  // namespace

PathArrays path_arrays(const Scene& scene, const EffectSet& effects, std::span<const Triangle> triangles) {
  PathArrays arrays;
  if (!effects.follows_paths()) return arrays;
  for (const Material& material : scene.materials) {
    arrays.materials.push_back({flush_to_zero(glm::clamp(material.emission, 0.0f, brightest)),
                                flush_to_zero(glm::clamp(material.diffuse, 0.0f, 1.0f))});
    arrays.path_materials.push_back(path_material(material, effects));
  }
  EnvironmentMap map;
  std::string warning;
  if (effects.is_used(Effect::environment)) map = environment_map(*scene.environment, warning);
  if (!warning.empty()) arrays.warnings.push_back(std::move(warning));
  add_choices(scene, effects, triangles, map, arrays);
  add_surroundings(scene, map, arrays);
  if (effects.is_used(Effect::fog)) add_fog(*scene.fog, triangles, arrays);
  PathCounts& counts = arrays.counts;
  const bool diffuse = effects.has(Effect::global_illumination);
  counts.follows = true;
  counts.lobes = (diffuse ? PATH_LOBE_DIFFUSE : 0) |
                 (effects.has(Effect::reflection) ? PATH_LOBE_REFLECTS : 0) |
                 (effects.has(Effect::refraction) ? PATH_LOBE_TRANSMITS : 0);
  counts.bounces = counts.lobes != 0 ? std::min(scene.bounces, MAX_BOUNCES) : 0;
  counts.bounces_light = diffuse;
  return arrays;
}

}  // namespace coppice
