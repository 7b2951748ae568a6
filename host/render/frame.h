#pragma once

#include <optional>
#include <span>

#include "builders/bvh.h"
#include "pipeline/trace_pieces.h"
#include "pipeline/wide_plan.h"
#include "render/film.h"
#include "render/scene_arrays.h"

namespace coppice {

// A frame: a tree, built on the device or handed over by the host, and a picture traced through it. Of a
// scene with instances two levels, which only the device builds and only the binary walk takes.
struct FrameOptions {
  std::optional<BuildOptions> build{};  // none: the tree is uploaded
  std::uint64_t node_count = 0;         // of the uploaded tree
  TraceOptions trace;                   // and whether the tree is converted to wide nodes
};

struct FramePlan {
  std::optional<BuildPlan> build;
  std::optional<WidePlan> wide;
  std::optional<TwoLevels> levels;  // then `build` is that of the tree over the instances
  TreeSlots tree;
  TracePlan trace;

  TracePieces pieces(const TracePlan& of, std::uint32_t first_pixel = 0) const {
    return {tree, of, first_pixel, levels ? &*levels : nullptr};
  }
};

// Lights, textures and alpha are those of the scene, whatever the options say. Throws LayoutError if a slot
// does not fit a block, and std::invalid_argument for instances with a tree of the host, a wide one, shadows,
// occlusion, textures or alpha, and for shadows, occlusion or alpha without a tree.
FramePlan plan_frame(Layout& layout, const SceneArrays& scene, const FrameOptions& options);

// The parts of a frame: nothing where there is nothing to do.
void append_frame_build(Chain& chain, const FramePlan& plan);
void append_frame_wide(Chain& chain, const FramePlan& plan);

// Of two levels the trees of the meshes, which append_frame_build begins with.
void append_frame_meshes(Chain& chain, const FramePlan& plan);

// All of it: triangles to picture.
void append_frame(Chain& chain, const FramePlan& plan);

template <class Executor>
void upload_textures(Executor& executor, const TextureSlots& slots, const SceneArrays& scene) {
  const TextureArrays& textures = scene.textures;
  executor.upload(slots.materials, std::span<const TexturedMaterial>(scene.textured_materials));
  executor.upload(slots.maps, std::span<const MaterialTextures>(textures.materials));
  executor.upload(slots.headers, std::span<const TextureHeader>(textures.headers));
  executor.upload(slots.texels, std::span<const uint>(textures.texels));
  executor.upload(slots.srgb_to_linear, std::span<const float>(textures.srgb_to_linear));
  executor.upload(slots.corners, std::span<const CornerAttributes>(scene.corners));
}

template <class Executor>
void upload_alpha(Executor& executor, const AlphaSlots& slots, const AlphaArrays& alpha) {
  executor.upload(slots.triangles, std::span<const AlphaTriangle>(alpha.triangles));
  executor.upload(slots.maps, std::span<const AlphaMap>(alpha.maps));
  executor.upload(slots.texels, std::span<const uint>(alpha.texels));
}

template <class Executor>
void upload_paths(Executor& executor, const PathSlots& slots, const PathArrays& paths) {
  executor.upload(slots.materials, std::span<const SurfaceMaterial>(paths.materials));
  executor.upload(slots.path_materials, std::span<const PathMaterial>(paths.path_materials));
  executor.upload(slots.surroundings, std::span<const Surrounding>(paths.surroundings));
  executor.upload(slots.lights, std::span<const LightSource>(paths.lights));
  executor.upload(slots.choices, std::span<const LightChoice>(paths.choices));
  executor.upload(slots.emitter_probability, std::span<const float>(paths.emitter_probability));
}

// Uploads all that a build and a trace read, through any executor.
template <class Executor>
void upload_frame(Executor& executor, const TreeSlots& tree, const TracePlan& trace, const SceneArrays& scene,
                  const Film& film) {
  const auto thresholds = srgb_thresholds();
  executor.upload(tree.triangles, std::span<const Triangle>(scene.triangles));
  executor.upload(trace.material_index, std::span<const uint>(scene.material_index));
  executor.upload(trace.materials, std::span<const SurfaceMaterial>(scene.materials));
  executor.upload(trace.lighting, std::span<const Lighting>(&scene.lighting, 1));
  executor.upload(trace.film, std::span<const Film>(&film, 1));
  executor.upload(trace.srgb_thresholds, std::span<const uint>(thresholds));
  if (trace.lights.sources.count > 0)
    executor.upload(trace.lights.sources, std::span<const LightSource>(scene.lights));
  if (trace.lights.ambient.count > 0)
    executor.upload(trace.lights.ambient, std::span<const AmbientLight>(&scene.ambient, 1));
  if (trace.textures.headers.count > 0) upload_textures(executor, trace.textures, scene);
  if (trace.filter.alpha.any()) upload_alpha(executor, trace.filter.alpha, scene.alpha);
  if (trace.options.paths.any()) upload_paths(executor, trace.paths, scene.paths);
}

// The same of a frame with or without instances.
template <class Executor>
void upload_frame(Executor& executor, const FramePlan& plan, const SceneArrays& scene, const Film& film) {
  if (!plan.levels) return upload_frame(executor, plan.tree, plan.trace, scene, film);
  SceneArrays no_triangles;
  no_triangles.materials = scene.materials;
  no_triangles.lighting = scene.lighting;
  no_triangles.lights = scene.lights;
  upload_frame(executor, plan.tree, plan.trace, no_triangles, film);
  const InstancePlan& instances = plan.levels->plan;
  executor.upload(instances.meshes, std::span<const MeshRange>(instances.ranges));
  for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    const std::uint32_t first = scene.meshes[mesh].first_triangle, count = scene.meshes[mesh].triangle_count;
    const auto materials = std::span<const uint>(scene.material_index).subspan(first, count);
    Slot<uint> own{plan.levels->hits.mesh_materials.place, count};
    own.place.offset += sizeof(uint) * instances.ranges[mesh].first_triangle;
    executor.upload(triangles_of(instances, mesh),
                    std::span<const Triangle>(scene.triangles).subspan(first, count));
    executor.upload(own, materials);
  }
  executor.upload(instances.mesh_index, std::span<const uint>(scene.mesh_index));
  executor.upload(instances.transforms, std::span<const InstanceTransform>(scene.transforms));
}

// Throws DeviceError for a tree that is higher than tracers on the device take.
void check_height(const Bvh& bvh);

// Uploads a tree of the host.
template <class Executor>
void upload_bvh(Executor& executor, const TreeSlots& tree, const Bvh& bvh) {
  check_height(bvh);
  BuildState state{};
  state.active_count = bvh.active_count;
  executor.upload(tree.nodes, std::span<const Node>(bvh.nodes));
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
}

}  // namespace coppice
