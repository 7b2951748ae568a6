#include "apps/open_device.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "render/scene_room.h"
#include "scene/input_error.h"
#include "scene/texture.h"

namespace coppice {

namespace {

// ./run.sh unpacks a newer lavapipe beside the program. It takes libraries of its own, so it must be named
// before the program starts.
std::string remedy_of_slow_driver() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path newer = program.parent_path() / "lavapipe";
  if (!std::filesystem::exists(newer / "lvp_icd.json", error))
    return "./run.sh fetches a newer one and runs on it";
  return "run it by ./run.sh, or with VK_DRIVER_FILES=" + (newer / "lvp_icd.json").string() +
         " LD_LIBRARY_PATH=" + (newer / "lib").string();
}

std::optional<BuildOptions> build_of(const BuilderChoice& builder) {
  return builder.on_device() ? std::optional(builder.least_build_options()) : std::nullopt;
}

}  // namespace

void print_note(const std::string& line) { std::fprintf(stderr, "note: %s\n", line.c_str()); }

void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

Scene open_scene_of(const SceneOptions& options, const BuilderChoice& builder, const DeviceSetup& device,
                    bool on_device) {
  Scene scene =
      open_scene_with_room(options, on_device ? &device.options : nullptr, build_of(builder), print_note);
  print_warnings(scene.warnings);
  return scene;
}

Scene open_for_effects(const SceneOptions& options, const BuilderChoice& builder, const DeviceSetup& device,
                       bool on_device, bool may_stand_still) {
  const auto open = [&](const SceneOptions& of) {
    Scene scene =
        open_scene_with_room(of, on_device ? &device.options : nullptr, build_of(builder), print_note);
    if (!options.effects.turns_off(Effect::alpha)) find_cut_outs(scene);
    return scene;
  };
  Scene scene = open(options);
  const EffectSet effects = effects_of(scene, options.effects);
  if (!scene.instances.empty() && effects.needs_one_level()) {
    const bool moves = scene.swarm || scene.motion;
    SceneOptions one_level = options;
    one_level.keep_instances = false;
    scene = open(one_level);
    if (effects.has(Effect::shadows) && moves && !scene.motion && !may_stand_still)
      throw InputError("scene '" + scene.name +
                       "' has instances that move, through which no shadow rays are traced "
                       "(--effects=-shadows goes without)");
    if (effects.has(Effect::ambient_occlusion) && moves && !scene.motion && !may_stand_still)
      throw InputError("scene '" + scene.name +
                       "' has instances that move, through which no occlusion rays are traced "
                       "(--effects=-ambient_occlusion goes without)");
    if (effects.follows_paths() && moves && !scene.motion && !may_stand_still)
      throw InputError("scene '" + scene.name +
                       "' has instances that move, through which no paths of light are traced (--effects=" +
                       without(effects.path_effects()) + " goes without)");
  }
  print_warnings(scene.warnings);
  return scene;
}

SceneArrays picture_arrays(const Scene& scene, const EffectChanges& effects) {
  SceneArrays arrays = scene_arrays(scene, effects_of(scene, effects));
  print_warnings(arrays.image_warnings());
  return arrays;
}

CheckedDevice open_device(const DeviceSetup& device, const DeviceUse& use) {
  DeviceOptions options = device.options;
  // For tests: as a device without timestamps.
  if (const char* const without = std::getenv("COPPICE_NO_TIMESTAMPS"); without && *without)
    options.timestamps = false;
  options.pipeline_folder = cache_folder();
  DeviceChoices choices = device.choices;
  choices.slow_driver_remedy = remedy_of_slow_driver();
  return CheckedDevice(options, choices, use, print_note, isatty(STDERR_FILENO) ? print_note : Note());
}

CheckedDevice open_device(const DeviceSetup& device, const BuilderChoice& builder) {
  return open_device(device, DeviceUse{.build = builder.least_build_options(), .traces = {}});
}

int validation_status(CheckedDevice& device) {
  const auto messages = device.device().take_validation_messages();
  for (const std::string& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
  return messages.empty() ? 0 : 1;
}

}  // namespace coppice
