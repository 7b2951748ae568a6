#pragma once

#include <algorithm>

#include "measure/effects_report.h"
#include "render/frame.h"
#include "scene/effect_set.h"
#include "support/scene_file_text.h"

namespace coppice {

using nlohmann::json;

inline Scene with_lights(const std::vector<json>& lights, const json& light = nullptr) {
  json file = with_object();
  file["lights"] = lights;
  if (!light.is_null()) file["light"] = light;
  return read_scene(file);
}

inline Scene with_light(const json& light = json::object()) {
  json file = with_object();
  file["light"] = light;
  return read_scene(file);
}

inline const json sun = {{"direction", {0, 2, 0}}}, lamp = {{"position", {1, 2, 3}}};

inline json shadowed(json light) {
  light["shadows"] = true;
  return light;
}

// "" where it is off.
inline std::string caller(const Scene& scene, Effect effect) {
  return effects_of(scene).of(effect).called_by;
}

inline RecordedPicture recorded(const Scene& scene, const char* changes = "", std::uint32_t samples = 1,
                                Walk walk = Walk::binary) {
  FrameOptions options{.build = BuildOptions{}, .trace = {}};
  options.trace.width = 40;
  options.trace.height = 30;
  options.trace.samples = samples;
  options.trace.walk = walk;
  return recorded_picture(scene_arrays(scene, effects_of(scene, EffectChanges(changes))), options);
}

inline std::string kernels_of(const RecordedPicture& picture) {
  std::string text;
  for (const RecordedPicture::Kernel& kernel : picture.kernels)
    text += (text.empty() ? "" : " ") + kernel.name + "*" + std::to_string(kernel.dispatches);
  return text;
}

inline bool has_slot(const RecordedPicture& picture, const std::string& name) {
  return std::ranges::find(picture.slots, name) != picture.slots.end();
}

}  // namespace coppice
