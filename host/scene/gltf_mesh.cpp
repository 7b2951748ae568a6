#include "scene/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace coppice {
namespace {

template <class Vector = glm::vec3>
std::vector<Vector> vectors_of(const std::vector<float>& numbers) {
  std::vector<Vector> vectors(numbers.size() * sizeof(float) / sizeof(Vector));
  if (!vectors.empty()) std::memcpy(vectors.data(), numbers.data(), vectors.size() * sizeof(Vector));
  return vectors;
}

// glTF 2.0, 3.7.2.1.
std::vector<glm::uvec3> triangles_of(const std::vector<std::uint32_t>& corners, int mode) {
  std::vector<glm::uvec3> triangles;
  const std::size_t count = corners.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.resize(count / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    }
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
    } else {
      triangles.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
    }
  }
  return triangles;
}

std::vector<std::uint32_t> corners_of(const GltfDocument& document, const GltfAccessors& accessors,
                                      const tinygltf::Primitive& from, const GltfPrimitive& primitive) {
  if (from.indices < 0) {
    std::vector<std::uint32_t> corners(primitive.positions.size());
    std::iota(corners.begin(), corners.end(), 0u);
    return corners;
  }
  std::vector<std::uint32_t> corners =
      accessors.integers(from.indices, "SCALAR", 4, primitive.pointer + "/indices");
  const auto wrong = std::find_if(corners.begin(), corners.end(),
                                  [&](std::uint32_t corner) { return corner >= primitive.positions.size(); });
  if (wrong != corners.end()) {
    document.fail("/accessors/" + std::to_string(from.indices),
                  "index " + std::to_string(wrong - corners.begin()) + " is " + std::to_string(*wrong) +
                      ", expected one below " + std::to_string(primitive.positions.size()) +
                      ", the number of vertices of " + primitive.pointer);
  }
  return corners;
}

void check_count(const GltfDocument& document, const GltfAccessors& accessors, int accessor,
                 const GltfPrimitive& primitive, const std::string& user) {
  const std::size_t count = accessors.count(accessor, user);
  if (count == primitive.positions.size()) return;
  document.fail("/accessors/" + std::to_string(accessor) + "/count",
                std::to_string(count) + ", expected " + std::to_string(primitive.positions.size()) +
                    ", the number of vertices of " + primitive.pointer);
}

void read_corner_attributes(const GltfDocument& document, const GltfAccessors& accessors,
                            const tinygltf::Primitive& from, GltfPrimitive& primitive) {
  const auto read = [&](const char* attribute, const char* type) {
    const auto found = from.attributes.find(attribute);
    if (found == from.attributes.end()) return std::vector<float>{};
    const std::string user = primitive.pointer + "/attributes/" + attribute;
    check_count(document, accessors, found->second, primitive, user);
    return accessors.floats(found->second, type, user);
  };
  primitive.texcoords = vectors_of<glm::vec2>(read("TEXCOORD_0", "VEC2"));
  primitive.normals = vectors_of(read("NORMAL", "VEC3"));
}

void read_targets(const GltfDocument& document, const GltfAccessors& accessors,
                  const tinygltf::Primitive& from, GltfPrimitive& primitive) {
  for (std::size_t i = 0; i < from.targets.size(); ++i) {
    primitive.targets.emplace_back();
    const auto position = from.targets[i].find("POSITION");
    if (position == from.targets[i].end()) continue;
    const std::string user = primitive.pointer + "/targets/" + std::to_string(i) + "/POSITION";
    check_count(document, accessors, position->second, primitive, user);
    primitive.targets.back() = vectors_of(accessors.floats(position->second, "VEC3", user));
  }
}

// One vertex's influences of all sets, the largest four of them, that add up to 1.
struct Influences {
  std::array<std::uint16_t, 4> joints{};
  glm::vec4 weights{0};
  bool has_more = false, has_none = false;
};

Influences influences_of(const std::vector<std::pair<float, std::uint16_t>>& all) {
  Influences result;
  std::vector<std::pair<float, std::uint16_t>> used;
  for (const auto& influence : all) {
    if (influence.first > 0 && std::isfinite(influence.first)) used.push_back(influence);
  }
  if (used.size() > 4) {
    std::stable_sort(used.begin(), used.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    used.resize(4);
    result.has_more = true;
  }
  double sum = 0;
  for (const auto& influence : used) sum += influence.first;
  if (used.empty()) {
    result.has_none = true;
    result.weights.x = 1;
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    result.weights[static_cast<int>(k)] = static_cast<float>(used[k].first / sum);
    result.joints[k] = used[k].second;
  }
  return result;
}

void read_influences(const GltfDocument& document, const GltfAccessors& accessors,
                     const tinygltf::Primitive& from, std::size_t skin_joints, GltfPrimitive& primitive,
                     SceneNotes& notes) {
  const std::size_t count = primitive.positions.size();
  std::vector<std::vector<std::pair<float, std::uint16_t>>> all(count);
  for (int set = 0;; ++set) {
    const auto joints_at = from.attributes.find("JOINTS_" + std::to_string(set));
    const auto weights_at = from.attributes.find("WEIGHTS_" + std::to_string(set));
    const bool has_joints = joints_at != from.attributes.end(),
               has_weights = weights_at != from.attributes.end();
    if (has_joints != has_weights || (set == 0 && !has_joints)) {
      document.fail(
          primitive.pointer + "/attributes",
          (has_joints ? "WEIGHTS_" : "JOINTS_") + std::to_string(set) + " is missing, the skin needs it");
    }
    if (!has_joints) break;
    const std::string joints_user = primitive.pointer + "/attributes/" + joints_at->first;
    const std::string weights_user = primitive.pointer + "/attributes/" + weights_at->first;
    check_count(document, accessors, joints_at->second, primitive, joints_user);
    check_count(document, accessors, weights_at->second, primitive, weights_user);
    const std::vector<std::uint32_t> joints = accessors.integers(joints_at->second, "VEC4", 2, joints_user);
    const std::vector<float> weights = accessors.floats(weights_at->second, "VEC4", weights_user);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i] >= skin_joints && weights[i] != 0) {
        document.fail("/accessors/" + std::to_string(joints_at->second),
                      "joint " + std::to_string(joints[i]) + " of vertex " + std::to_string(i / 4) +
                          ", expected one below " + std::to_string(skin_joints) +
                          ", the number of joints of the skin");
      }
      all[i / 4].emplace_back(weights[i], static_cast<std::uint16_t>(joints[i]));
    }
  }
  for (const auto& vertex : all) {
    const Influences influences = influences_of(vertex);
    if (influences.has_more)
      notes.add(primitive.pointer, "vertices with more than 4 joints keep the 4 of most weight");
    if (influences.has_none)
      notes.add(primitive.pointer, "vertices without weights follow the skin's first joint");
    primitive.joints.push_back(influences.joints);
    primitive.weights.push_back(influences.weights);
  }
}

}  // namespace

GltfPrimitive read_gltf_primitive(const GltfDocument& document, const GltfAccessors& accessors,
                                  std::size_t mesh, std::size_t index, std::size_t skin_joints,
                                  SceneNotes& notes) {
  const tinygltf::Primitive& from = document.model.meshes[mesh].primitives[index];
  GltfPrimitive primitive;
  primitive.pointer = "/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(index);
  if (from.mode < TINYGLTF_MODE_TRIANGLES) {
    notes.add(primitive.pointer + "/mode", "lines and points are not drawn");
    return primitive;
  }
  const auto position = from.attributes.find("POSITION");
  if (position == from.attributes.end()) {
    notes.add(primitive.pointer + "/attributes", "primitives without POSITION are not drawn");
    return primitive;
  }
  primitive.positions =
      vectors_of(accessors.floats(position->second, "VEC3", primitive.pointer + "/attributes/POSITION"));
  primitive.triangles = triangles_of(corners_of(document, accessors, from, primitive), from.mode);
  if (from.material >= 0) {
    const std::size_t count = document.json.contains("materials") ? document.json["materials"].size() : 0;
    document.check_index(primitive.pointer + "/material", from.material, count, "materials");
    primitive.material = static_cast<std::uint32_t>(from.material) + 1;
  }
  if (from.attributes.contains("COLOR_0")) notes.add(primitive.pointer, "vertex colours are not used");
  read_corner_attributes(document, accessors, from, primitive);
  read_targets(document, accessors, from, primitive);
  if (skin_joints > 0) read_influences(document, accessors, from, skin_joints, primitive, notes);
  return primitive;
}

}  // namespace coppice
