#include "scene/effect_set.h"

#include <algorithm>
#include <iterator>

#include "scene/input_error.h"
#include "scene/opacity.h"
#include "scene/printable.h"
#include "scene/surface_effects.h"

namespace coppice {

namespace {

bool is_bright(const glm::vec3& radiance) { return radiance != glm::vec3(0); }

// All that light anything, the directional one first.
std::vector<Light> bright_lights(const Scene& scene) {
  std::vector<Light> lights;
  const DirectionalLight& first = scene.light;
  if (is_bright(first.radiance)) {
    const std::string origin = scene.light_origin.empty() ? "the directional light" : scene.light_origin;
    lights.push_back({false, first.direction, first.radiance, 1, first.shadows, origin});
  }
  std::ranges::copy_if(scene.more_lights, std::back_inserter(lights),
                       [](const Light& light) { return is_bright(light.radiance); });
  return lights;
}

std::string known_effects() {
  std::string names;
  for (const std::string_view name : EFFECT_NAMES) names.append(names.empty() ? "" : ", ").append(name);
  return names;
}

std::string quoted(const Material& material) {
  return "material '" + printable(std::string_view(material.name)) + "'";
}

// By the first triangle whose material says so: `why` is empty of one that does not.
template <class Why>
void call_by_material(const Scene& scene, Effect effect, EffectSet& effects, const Why& why) {
  std::vector<std::string> reasons;
  for (const Material& material : scene.materials) reasons.push_back(why(material));
  const auto caller = std::ranges::find_if(scene.material_index,
                                           [&](std::uint32_t index) { return !reasons[index].empty(); });
  if (caller == scene.material_index.end()) return;
  effects.call(effect, quoted(scene.materials[*caller]) + ", " + reasons[*caller]);
}

std::string which_has(const TextureMap& map) { return "which has " + printable(std::string_view(map.name)); }

// A map of colours.
std::string why_textures(const Material& material) {
  if (material.diffuse_map) return which_has(material.diffuse_map);
  return material.emission_map ? which_has(material.emission_map) : "";
}

// A map of opacity, or less than all of the surface.
std::string why_alpha(const Material& material) {
  if (!lets_rays_through(material)) return "";
  if (material.opacity_map) return which_has(material.opacity_map);
  std::string coverage = std::to_string(coverage_of(material));
  coverage.erase(coverage.find_last_not_of('0') + 1);
  if (coverage.ends_with('.')) coverage.pop_back();
  return "of whose surface " + coverage + " is there";
}

// By the materials of triangles, in the order of triangles.
void call_for_paths(const Scene& scene, EffectSet& effects) {
  std::vector<bool> seen(scene.materials.size());
  for (const std::uint32_t index : scene.material_index) {
    if (seen[index]) continue;
    seen[index] = true;
    const Material& material = scene.materials[index];
    if (is_emitter(material)) effects.call(Effect::emission, quoted(material) + ", which emits light");
    if (is_reflecting(material)) effects.call(Effect::reflection, quoted(material) + ", which reflects");
    if (transmission_of(material) > 0)
      effects.call(Effect::refraction, quoted(material) + ", through which light goes");
  }
  if (scene.global_illumination) effects.call(Effect::global_illumination, "/global_illumination");
  if (scene.environment && scene.environment->intensity > 0)
    effects.call(Effect::environment, scene.environment->origin);
  if (scene.fog) effects.call(Effect::fog, scene.fog->origin);
}

// What `shadows` says about lights that may cast them.
void cast_shadows(std::vector<Light>& lights, const EffectSet& effects) {
  const bool shadows = effects.has(Effect::shadows);
  const bool all_cast = shadows && effects.of(Effect::shadows).overridden;
  for (Light& light : lights) light.shadows = shadows && (light.shadows || all_cast);
}

// Without the effect only the directional light, if it is one.
std::vector<Light> lights_with(const Scene& scene, const EffectSet& effects) {
  std::vector<Light> lights = bright_lights(scene);
  if (effects.has(Effect::lights)) return lights;
  std::erase_if(lights, [](const Light& light) { return light.is_point; });
  if (lights.size() > 1) lights.resize(1);
  return lights;
}

}  // namespace

void EffectSet::call(Effect effect, const std::string& by) {
  State& state = states_[static_cast<std::size_t>(effect)];
  if (!state.called_by.empty()) return;
  state.on = state.on || !state.overridden;
  state.called_by = by;
}

void EffectSet::override(Effect effect, bool on) {
  State& state = states_[static_cast<std::size_t>(effect)];
  state.on = on;
  state.overridden = true;
}

std::vector<Effect> EffectSet::path_effects() const {
  std::vector<Effect> effects;
  if (has(Effect::global_illumination)) effects.push_back(Effect::global_illumination);
  for (const Effect effect :
       {Effect::emission, Effect::reflection, Effect::refraction, Effect::environment, Effect::fog}) {
    if (is_used(effect)) effects.push_back(effect);
  }
  return effects;
}

std::string without(std::span<const Effect> effects) {
  std::string text;
  for (const Effect effect : effects) text.append(text.empty() ? "-" : ",-").append(name_of(effect));
  return text;
}

std::string no_effects() {
  std::vector<Effect> all;
  for (std::size_t i = 0; i < effect_count; ++i) all.push_back(static_cast<Effect>(i));
  return without(all);
}

// THE TABLE of docs/effects.md, line by line.
EffectSet effects_of(const Scene& scene, const EffectChanges& changes) {
  EffectSet effects;
  std::size_t count = 0;
  for (const Light& light : bright_lights(scene)) {
    ++count;
    if (light.is_point) effects.call(Effect::lights, light.origin + ", a point");
    if (count > 1) effects.call(Effect::lights, light.origin + ", light number " + std::to_string(count));
    if (light.shadows) effects.call(Effect::shadows, light.origin + ", which casts shadows");
  }
  call_by_material(scene, Effect::textures, effects, why_textures);
  call_by_material(scene, Effect::alpha, effects, why_alpha);
  if (scene.occlusion && is_bright(scene.ambient_light))
    effects.call(Effect::ambient_occlusion, "/ambient_occlusion");
  if (scene.lens.aperture > 0) effects.call(Effect::depth_of_field, scene.lens.origin);
  call_for_paths(scene, effects);
  effects = changes.applied_to(effects);
  for (const Effect light : {Effect::emission, Effect::environment}) {
    if (effects.is_used(light)) effects.call(Effect::shadows, effects.of(light).called_by);
  }
  return effects;
}

EffectChanges::EffectChanges(std::string_view text) : text_(text) {
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    const auto known =
        word.empty() ? std::end(EFFECT_NAMES) : std::ranges::find(EFFECT_NAMES, word.substr(1));
    if (known == std::end(EFFECT_NAMES) || (word[0] != '+' && word[0] != '-')) {
      throw InputError("'" + printable(word) + "' is no + or - and an effect behind it: there are " +
                       known_effects());
    }
    changes_.push_back({static_cast<Effect>(known - EFFECT_NAMES), word[0] == '+'});
    if (comma + 1 == text.size()) throw InputError("nothing behind the last comma");
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
}

EffectSet EffectChanges::applied_to(EffectSet effects) const {
  for (const Change& change : changes_) effects.override(change.effect, change.on);
  return effects;
}

bool EffectChanges::turns_off(Effect effect) const {
  const EffectSet::State state = applied_to({}).of(effect);
  return state.overridden && !state.on;
}

EffectChanges EffectChanges::but(Effect effect, bool on) const {
  EffectChanges changes = *this;
  changes.changes_.push_back({effect, on});
  changes.text_ += std::string(text_.empty() ? "" : ",") + (on ? "+" : "-") + std::string(name_of(effect));
  return changes;
}

bool occludes_ambient(const Scene& scene, const EffectSet& effects) {
  return effects.has(Effect::ambient_occlusion) && is_bright(scene.ambient_light) && !effects.follows_paths();
}

std::vector<Light> shaded_lights(const Scene& scene, const EffectSet& effects) {
  if (!effects.has(Effect::lights) && !effects.has(Effect::shadows) && !occludes_ambient(scene, effects))
    return {};
  std::vector<Light> lights = lights_with(scene, effects);
  cast_shadows(lights, effects);
  std::stable_partition(lights.begin(), lights.end(), [](const Light& light) { return !light.shadows; });
  return lights;
}

std::vector<Light> path_lights(const Scene& scene, const EffectSet& effects) {
  std::vector<Light> lights = lights_with(scene, effects);
  const bool default_light = scene.light_origin.empty() && !lights.empty() && !lights[0].is_point;
  const bool others = effects.is_used(Effect::emission) || effects.is_used(Effect::environment);
  if (default_light && others) lights.erase(lights.begin());
  cast_shadows(lights, effects);
  return lights;
}

}  // namespace coppice
