#include "fuzz/scene_complaint.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "scene/bounds.h"
#include "scene/motion.h"

namespace coppice {
namespace {

bool is_sound(const Material& material) {
  return is_finite(material.diffuse) && is_finite(material.specular) && is_finite(material.emission) &&
         std::isfinite(material.shininess) && std::isfinite(material.index_of_refraction) &&
         material.opacity >= 0 && material.opacity <= 1;
}

bool is_sound(const Environment& environment) {
  if (!(environment.intensity >= 0) || !std::isfinite(environment.rotation_degrees)) return false;
  if (!environment.sky) return !environment.image.empty();
  const Sky& sky = *environment.sky;
  return environment.image.empty() && is_finite(sky.sun) && sky.sun.y >= 0 && glm::length(sky.sun) > 0.99f &&
         glm::length(sky.sun) < 1.01f;
}

bool is_sound(const Fog& fog) {
  if (!(fog.density >= 0) || !is_finite(fog.albedo) || !(std::abs(fog.anisotropy) < 1)) return false;
  return !fog.box || (is_finite(fog.box->min) && is_finite(fog.box->max));
}

std::string complaint_about_motion(std::span<const glm::vec3> positions, const Motion& motion) {
  const std::size_t count = positions.size();
  const auto is_inside = [&](VertexRange range) {
    return range.first <= count && range.count <= count - range.first;
  };
  if (motion.rest.size() != count) return "vertices at rest";
  if (!(motion.duration_seconds > 0) || !(motion.frames_per_second > 0)) return "duration";
  const Pose pose = pose_at(motion, 0);
  for (const VertexSequence& sequence : motion.sequences) {
    if (!is_inside(sequence.vertices) || sequence.vertices.count == 0) return "range of a sequence";
    if (sequence.positions.empty() || sequence.positions.size() % sequence.vertices.count != 0)
      return "frames";
  }
  for (const MorphTarget& morph : motion.morphs) {
    if (!is_inside(morph.vertices) || morph.offsets.size() != morph.vertices.count)
      return "range of a morph target";
    if (morph.weight >= pose.morph_weights.size()) return "weight of a morph target";
  }
  for (const Deformation& deformation : motion.deformations) {
    if (!is_inside(deformation.vertices) || deformation.piece_vertices == 0) return "range of a deformation";
    if (!(deformation.size > 0) || !(deformation.seconds > 0)) return "size of a deformation";
  }
  if (motion.joints.size() != motion.weights.size()) return "count of weights";
  if (!motion.joints.empty() && motion.joints.size() != count) return "count of joints";
  for (const auto& joints : motion.joints) {
    if (*std::max_element(joints.begin(), joints.end()) >= pose.joints.size()) return "joint";
  }
  if (!is_same(positions_at(motion, 0), {positions.begin(), positions.end()})) return "positions at second 0";
  for (const double seconds : {-1.0, 0.37 * motion.duration_seconds, 1e9}) {
    const Pose other = pose_at(motion, seconds);
    if (other.joints.size() != pose.joints.size()) return "joints of another time";
    if (other.morph_weights.size() != pose.morph_weights.size()) return "weights of another time";
    positions_at(motion, seconds);
  }
  return "";
}

bool are_in_range(const std::vector<glm::uvec3>& index, std::size_t triangles, std::size_t count) {
  if (index.empty()) return count == 0;
  return index.size() == triangles && std::ranges::all_of(index, [&](const glm::uvec3& corners) {
           const auto is_sound = [&](std::uint32_t i) { return i < count || i == NO_ATTRIBUTE; };
           return is_sound(corners.x) && is_sound(corners.y) && is_sound(corners.z);
         });
}

std::string complaint_about_mesh(const Scene& scene, const InstancedMesh& mesh) {
  if (std::uint64_t{mesh.first_triangle} + mesh.triangle_count > scene.indices.size()) return "mesh";
  if (!mesh.motion) return "";
  const std::span<const glm::vec3> positions(scene.positions);
  const std::size_t count = mesh.motion->rest.size();
  if (mesh.first_vertex > positions.size() || count > positions.size() - mesh.first_vertex)
    return "vertices of a mesh";
  for (std::uint32_t i = 0; i < mesh.triangle_count; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = scene.indices[mesh.first_triangle + i][corner];
      if (vertex < mesh.first_vertex || vertex - mesh.first_vertex >= count) return "corner of a mesh";
    }
  }
  return complaint_about_motion(positions.subspan(mesh.first_vertex, count), *mesh.motion);
}

std::string complaint_about_instances(const Scene& scene) {
  for (const InstancedMesh& mesh : scene.meshes) {
    if (const std::string complaint = complaint_about_mesh(scene, mesh); !complaint.empty()) return complaint;
  }
  if (scene.motion) {
    const std::vector<std::uint32_t>& moved = scene.motion->moved_instances;
    if (!std::ranges::is_sorted(moved) || (!moved.empty() && moved.back() >= scene.instances.size()))
      return "instances that move";
    for (const double seconds : {0.0, 0.37 * scene.motion->duration_seconds, 1e9}) {
      if (instances_at(*scene.motion, seconds).size() != moved.size()) return "count of instances that move";
    }
  }
  for (const Instance& instance : scene.instances) {
    if (instance.mesh >= scene.meshes.size()) return "mesh of an instance";
  }
  if (scene.swarm && (!(scene.swarm->seconds > 0) || scene.instances.empty())) return "swarm";
  return "";
}

}  // namespace

bool is_one_line(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
}

bool is_same(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  const auto is_same_bits = [](glm::vec3 p, glm::vec3 q) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool are_nan = std::isnan(p[axis]) && std::isnan(q[axis]);
      if (!are_nan && std::bit_cast<std::uint32_t>(p[axis]) != std::bit_cast<std::uint32_t>(q[axis])) {
        return false;
      }
    }
    return true;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_bits);
}

std::string complaint_about(const Scene& scene) {
  for (const glm::uvec3 triangle : scene.indices) {
    if (std::max({triangle.x, triangle.y, triangle.z}) >= scene.positions.size()) return "vertex index";
  }
  if (scene.material_index.size() != scene.indices.size()) return "count of material indices";
  for (const std::uint32_t index : scene.material_index) {
    if (index >= scene.materials.size()) return "material index";
  }
  if (!are_in_range(scene.texcoord_index, scene.indices.size(), scene.texcoords.size()) ||
      !are_in_range(scene.normal_index, scene.indices.size(), scene.normals.size())) {
    return "corner attribute";
  }
  if (scene.materials.empty()) return "no material";
  for (const Material& material : scene.materials) {
    if (!is_sound(material)) return "material '" + material.name + "'";
  }
  for (const std::string& warning : scene.warnings) {
    if (!is_one_line(warning)) return "warning '" + warning + "'";
  }
  if (scene.environment && !is_sound(*scene.environment)) return "environment";
  if (scene.fog && !is_sound(*scene.fog)) return "fog";
  if (!is_finite(scene.light.direction)) return "light";
  for (const Light& light : scene.more_lights) {
    if (!is_finite(light.place) || !is_finite(light.radiance)) return "light " + light.origin;
  }
  if (scene.motion) {
    const std::span<const glm::vec3> positions(scene.positions);
    const std::string complaint =
        complaint_about_motion(scene.instances.empty() ? positions : positions.first(0), *scene.motion);
    if (!complaint.empty()) return complaint;
  }
  if (const std::string complaint = complaint_about_instances(scene); !complaint.empty()) return complaint;
  const Camera camera = frame_scene(scene, 1.5f);
  if (!is_finite(camera.position) || !is_finite(camera.target) || !is_finite(camera.up)) return "camera";
  return "";
}

}  // namespace coppice
