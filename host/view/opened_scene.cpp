#include "view/opened_scene.h"

#include <chrono>

#include "builders/registry.h"
#include "render/frame.h"
#include "render/scene_room.h"
#include "scene/texture.h"

namespace coppice {

namespace {

// Without a tree there are no shadows, no occlusion and no paths, and all is solid.
EffectSet effects_for_view(const SceneOptions& options, const BuilderChoice& builder, const Scene& scene) {
  EffectSet effects = effects_of(scene, options.effects);
  if (builder.on_device() || builder.name != "none") return effects;
  for (const Effect effect : effects.path_effects()) effects.override(effect, false);
  for (const Effect effect : {Effect::shadows, Effect::ambient_occlusion, Effect::alpha}) {
    if (effects.has(effect)) effects.override(effect, false);
  }
  return effects;
}

}  // namespace

bool keeps_instances(const BuilderChoice& builder, const WalkChoice& walk) {
  return builder.on_device() && walk.allows_binary();
}

OpenedScene open_for_view(const SceneOptions& options, const BuilderChoice& builder) {
  OpenedScene opened;
  opened.options = options;
  opened.builder = builder;
  SceneOptions kept = options;
  kept.keep_instances = true;
  const auto open = [&] {
    Scene scene = open_scene_with_room(kept, nullptr, {}, [](const std::string&) {});
    if (!options.effects.turns_off(Effect::alpha)) find_cut_outs(scene);
    return scene;
  };
  opened.scene = open();
  opened.has_instances = !opened.scene.instances.empty();
  kept.keep_instances =
      options.keep_instances && !effects_of(opened.scene, options.effects).needs_one_level();
  if (opened.has_instances && !kept.keep_instances) opened.scene = open();
  opened.arrays = scene_arrays(opened.scene, effects_for_view(options, builder, opened.scene));
  for (const std::string& warning : opened.arrays.image_warnings()) opened.scene.warnings.push_back(warning);
  opened.box = box_of_scene(opened.scene, opened.arrays);
  if (builder.on_device()) return opened;
  const auto start = std::chrono::steady_clock::now();
  const BuilderConfig config{.radius = builder.radius,
                             .morton_bits = builder.bits_for(opened.arrays.triangles),
                             .leaf_size = builder.leaf_size};
  opened.bvh = find_cpu_builder(builder.name).build(opened.arrays.triangles, config);
  check_height(opened.bvh);
  opened.build_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return opened;
}

}  // namespace coppice
