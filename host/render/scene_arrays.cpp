#include "render/scene_arrays.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "render/stage_values.h"
#include "scene/instances.h"
#include "scene/opacity.h"

namespace coppice {

namespace {

AmbientLight ambient_light(const Scene& scene, std::span<const Triangle> triangles) {
  double distance = scene.occlusion ? scene.occlusion->distance : 0;
  if (distance == 0) {
    const Aabb box = box_of(triangles);
    distance = OCCLUSION_SHARE * glm::distance(glm::dvec3(box.box_min), glm::dvec3(box.box_max));
  }
  return {flush_to_zero(scene.ambient_light),
          static_cast<float>(std::clamp(distance, double{FLT_MIN}, double{FLT_MAX}))};
}

// The light is part of the materials, or shading goes over a list of lights, which materials only reflect.
void add_lights(SceneArrays& arrays, const Scene& scene, const EffectSet& effects) {
  const std::vector<Light> lights =
      arrays.paths.counts.any() ? std::vector<Light>() : shaded_lights(scene, effects);
  for (const Light& light : lights) {
    arrays.lights.push_back(light_source(light));
    ++arrays.light_counts.lights;
    arrays.light_counts.shadows += light.shadows;
    arrays.light_counts.points |= light.is_point;
  }
  const bool occluded = occludes_ambient(scene, effects);
  if (occluded) arrays.ambient = ambient_light(scene, arrays.triangles);
  arrays.light_counts.occlusion = occluded;
  const bool listed = arrays.light_counts.any();
  for (const Material& material : scene.materials) {
    arrays.materials.push_back(
        {occluded ? material.emission : material.emission + material.diffuse * scene.ambient_light,
         listed ? flush_to_zero(material.diffuse) : material.diffuse * scene.light.radiance});
  }
  const vec3 direction = listed ? vec3(0) : scene.light.direction;
  arrays.lighting = {direction, 0, vec3(0.80f, 0.87f, 0.94f), 0, vec3(0.24f, 0.45f, 0.78f), 0};
}

// `arrays` has the materials.
void add_textures(SceneArrays& arrays, const Scene& scene) {
  arrays.textures = texture_arrays(scene);
  if (arrays.textures.empty()) return;
  arrays.corners = corner_attributes(scene);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    arrays.textured_materials.push_back(
        arrays.paths.counts.any()
            ? TexturedMaterial{arrays.paths.materials[i].ambient, vec3(0), arrays.paths.materials[i].diffuse}
            : TexturedMaterial{
                  material.emission,
                  arrays.light_counts.occlusion ? vec3(0) : material.diffuse * scene.ambient_light,
                  arrays.materials[i].diffuse});
  }
}

}  // namespace

SceneArrays scene_arrays(const Scene& scene) {
  return scene_arrays(scene, effects_of(scene, EffectChanges("-textures,-alpha")));
}

SceneArrays scene_arrays(const Scene& scene, const EffectSet& effects) {
  SceneArrays arrays;
  std::vector<vec3> positions;
  positions.reserve(scene.positions.size());
  for (const vec3& position : scene.positions) positions.push_back(flush_to_zero(position));
  arrays.triangles.reserve(scene.indices.size());
  for (const uvec3& corner : scene.indices) {
    arrays.triangles.push_back({positions[corner.x], positions[corner.y], positions[corner.z]});
  }
  arrays.material_index = scene.material_index;
  if (scene.instances.empty()) arrays.paths = path_arrays(scene, effects, arrays.triangles);
  add_lights(arrays, scene, effects);
  arrays.lens = effects.has(Effect::depth_of_field) && scene.lens.aperture > 0;
  if (effects.has(Effect::textures)) add_textures(arrays, scene);
  if (effects.has(Effect::alpha) && std::ranges::any_of(scene.materials, lets_rays_through))
    arrays.alpha = alpha_arrays(scene, arrays.corners.empty() ? corner_attributes(scene) : arrays.corners);
  arrays.meshes = scene.meshes;
  for (const Instance& instance : scene.instances) {
    arrays.mesh_index.push_back(instance.mesh);
    arrays.transforms.push_back(rows_of(instance.transform));
  }
  return arrays;
}

std::vector<std::string> SceneArrays::image_warnings() const {
  std::vector<std::string> all = paths.warnings;
  all.insert(all.end(), textures.warnings.begin(), textures.warnings.end());
  // An image may be one of colours and of opacity, and is then said once.
  std::ranges::copy_if(alpha.warnings, std::back_inserter(all), [&](const std::string& warning) {
    return std::ranges::find(textures.warnings, warning) == textures.warnings.end();
  });
  return all;
}

Aabb box_of(std::span<const Triangle> triangles) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Aabb box{vec3(infinity), vec3(-infinity)};
  const auto is_finite = [](vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (const Triangle& triangle : triangles) {
    if (!is_finite(triangle.a) || !is_finite(triangle.b) || !is_finite(triangle.c)) continue;
    for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
      for (int axis = 0; axis < 3; ++axis) {
        box.box_min[axis] = std::min(box.box_min[axis], corner[axis]);
        box.box_max[axis] = std::max(box.box_max[axis], corner[axis]);
      }
    }
  }
  return box.box_min.x <= box.box_max.x ? box : Aabb{vec3(0), vec3(0)};
}

Aabb box_of_scene(const Scene& scene, const SceneArrays& arrays) {
  if (scene.instances.empty()) return box_of(arrays.triangles);
  return box_of(scene_arrays(boxes_of_instances(scene)).triangles);
}

}  // namespace coppice
