#pragma once

#include <span>
#include <vector>

#include "interface/instances.h"
#include "pipeline/alpha.h"
#include "pipeline/textures.h"
#include "render/alpha_arrays.h"
#include "render/path_arrays.h"
#include "render/texture_arrays.h"
#include "scene/effect_set.h"

namespace coppice {

// A scene as the stages take it.
struct SceneArrays {
  std::vector<Triangle> triangles;  // denormal coordinates and -0 as +0: what every device computes alike
  std::vector<uint> material_index;
  std::vector<SurfaceMaterial> materials;
  Lighting lighting = {};
  std::vector<LightSource> lights;  // that shading goes over, see LightCounts; none: the one of `lighting`
  LightCounts light_counts;
  AmbientLight ambient = {};  // where it is occluded, and not part of the materials
  bool lens = false;          // depth of field is asked for, and the scene has an aperture
  PathArrays paths;           // that shading is left to, if there are any
  // Where textures are asked for, and there are some:
  TextureArrays textures;
  std::vector<TexturedMaterial> textured_materials;
  std::vector<CornerAttributes> corners;
  AlphaArrays alpha;  // where it is asked for, and some triangles let rays through
  // Of a scene with instances: its meshes, and of each instance the mesh and the transform.
  std::vector<InstancedMesh> meshes;
  std::vector<uint> mesh_index;
  std::vector<InstanceTransform> transforms;

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles.size()); }
  TextureCounts texture_counts() const {
    return {static_cast<std::uint32_t>(textures.headers.size()), textures.texels.size()};
  }
  AlphaCounts alpha_counts() const {
    return {static_cast<std::uint32_t>(alpha.maps.size()), alpha.texels.size()};
  }
  // About images, of the environment, of textures and of opacity.
  std::vector<std::string> image_warnings() const;
  // Of the tree over the scene: instances, where there are two levels.
  std::uint32_t primitive_count() const {
    return mesh_index.empty() ? triangle_count() : static_cast<std::uint32_t>(mesh_index.size());
  }
};

// With the effects that it calls for, but for textures and alpha, whose images are then not opened; or with
// these.
SceneArrays scene_arrays(const Scene& scene);
SceneArrays scene_arrays(const Scene& scene, const EffectSet& effects);

// Of the active triangles; zeroes where there are none.
Aabb box_of(std::span<const Triangle> triangles);

// The same of a scene, or of the boxes of its instances.
Aabb box_of_scene(const Scene& scene, const SceneArrays& arrays);

}  // namespace coppice
