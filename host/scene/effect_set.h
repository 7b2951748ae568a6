#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace coppice {

// What is simulated only where a scene calls for it. The table in docs/effects.md says what calls for which,
// and what each adds.
enum class Effect : std::uint32_t {
  lights,
  shadows,
  textures,
  depth_of_field,
  ambient_occlusion,
  emission,
  reflection,
  refraction,
  global_illumination,
  alpha,
  environment,
  fog
};

inline constexpr std::string_view EFFECT_NAMES[] = {
    "lights",      "shadows",    "textures",   "depth_of_field",      "ambient_occlusion",
    "emission",    "reflection", "refraction", "global_illumination", "alpha",
    "environment", "fog"};
inline constexpr std::size_t effect_count = std::size(EFFECT_NAMES);

constexpr std::string_view name_of(Effect effect) { return EFFECT_NAMES[static_cast<std::size_t>(effect)]; }

// The effects of a scene, and why each is on or off.
class EffectSet {
 public:
  struct State {
    bool on = false;
    std::string called_by;  // what called for it, turned off or not; empty: nothing did
    bool overridden = false;
  };

  bool has(Effect effect) const { return of(effect).on; }
  const State& of(Effect effect) const { return states_[static_cast<std::size_t>(effect)]; }

  // On, and the scene has something for it: what is turned on and nothing has takes nothing.
  bool is_used(Effect effect) const { return has(effect) && !of(effect).called_by.empty(); }

  // Those for which light is followed along paths, in the place of being shaded where the camera's rays end.
  std::vector<Effect> path_effects() const;
  bool follows_paths() const { return !path_effects().empty(); }

  // Whether some effect takes triangles of one level: instances are then flattened.
  bool needs_one_level() const {
    return has(Effect::shadows) || has(Effect::ambient_occlusion) || is_used(Effect::textures) ||
           is_used(Effect::alpha) || follows_paths();
  }

  // The first thing that calls for an effect is the one that is named.
  void call(Effect effect, const std::string& by);
  void override(Effect effect, bool on);

 private:
  std::array<State, effect_count> states_;
};

// Effects that somebody wants or does not want, whatever the scene calls for.
class EffectChanges {
 public:
  EffectChanges() = default;
  // Of a text like "+shadows,-lights". Throws InputError for anything else.
  explicit EffectChanges(std::string_view text);

  EffectSet applied_to(EffectSet effects) const;
  // With one change more.
  EffectChanges but(Effect effect, bool on) const;
  bool turns_off(Effect effect) const;
  bool empty() const { return changes_.empty(); }
  const std::string& text() const { return text_; }

 private:
  struct Change {
    Effect effect;
    bool on;
  };
  std::vector<Change> changes_;
  std::string text_;
};

// Changes that turn these off, as a text.
std::string without(std::span<const Effect> effects);

// Changes that turn all effects off.
std::string no_effects();

// What a scene calls for, changed or not.
EffectSet effects_of(const Scene& scene, const EffectChanges& changes = {});

// Whether something may keep ambient light off: the effect is on, there is some, and paths, which ambient
// light reaches otherwise, are not followed.
bool occludes_ambient(const Scene& scene, const EffectSet& effects);

// The lights that shading goes over with these effects, those that cast shadows last, each in the scene's
// order; none where the directional light alone, without shadows, and plain ambient light are all there is.
std::vector<Light> shaded_lights(const Scene& scene, const EffectSet& effects);

// Those that paths choose from, which emitters and the environment come beside: where there are any, the
// default light is left out.
std::vector<Light> path_lights(const Scene& scene, const EffectSet& effects);

}  // namespace coppice
