#include "scene/instances.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "scene/bounds.h"
#include "scene/corner_attributes.h"
#include "scene/input_error.h"
#include "scene/motion.h"
#include "scene/random.h"
#include "scene/shapes.h"

namespace coppice {
namespace {

// As every device has it: what is denormal or -0 counts as +0, in and out of every operation.
float kept(float x) { return std::isnormal(x) || !std::isfinite(x) ? x : 0.0f; }

float moved_coordinate(const glm::mat4x3& transform, int row, glm::vec3 position) {
  const auto by = [&](int column) { return kept(transform[column][row]); };
  const float x = kept(by(0) * position.x), y = kept(by(1) * position.y), z = kept(by(2) * position.z);
  return kept(kept(kept(x + y) + z) + by(3));
}

glm::vec3 moved(const glm::mat4x3& transform, glm::vec3 position) {
  const glm::vec3 from{kept(position.x), kept(position.y), kept(position.z)};
  return {moved_coordinate(transform, 0, from), moved_coordinate(transform, 1, from),
          moved_coordinate(transform, 2, from)};
}

// Appends one instance of a mesh, with the vertices from the first to the last that its triangles have.
void append_instance(const Scene& scene, const Instance& instance, Scene& flat) {
  const InstancedMesh& mesh = scene.meshes[instance.mesh];
  const auto first = scene.indices.begin() + mesh.first_triangle, last = first + mesh.triangle_count;
  std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
  std::for_each(first, last, [&](const glm::uvec3& corners) {
    low = std::min({low, corners.x, corners.y, corners.z});
    high = std::max({high, corners.x, corners.y, corners.z});
  });
  const auto base = static_cast<std::uint32_t>(flat.positions.size());
  for (std::uint32_t vertex = low; vertex <= high && first != last; ++vertex)
    flat.positions.push_back(moved(instance.transform, scene.positions[vertex]));
  std::for_each(first, last,
                [&](const glm::uvec3& corners) { flat.indices.push_back(corners - low + base); });
  append_corner_attributes(scene, mesh.first_triangle, mesh.triangle_count,
                           {glm::dmat4(glm::mat4(instance.transform))}, flat);
  const auto materials = scene.material_index.begin() + mesh.first_triangle;
  flat.material_index.insert(flat.material_index.end(), materials, materials + mesh.triangle_count);
}

void append_box(Scene& scene, float half, std::uint32_t material) {
  const auto corner = [&](int i) { return half * glm::vec3{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}; };
  constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& [a, b, c, d] : faces) {
    append_triangle(scene, corner(a), corner(b), corner(c), material);
    append_triangle(scene, corner(a), corner(c), corner(d), material);
  }
}

void append_bush(Scene& scene, Random& random, std::uint32_t material) {
  for (int leaf = 0; leaf < 40; ++leaf) {
    const glm::vec3 out = random.direction();
    const glm::vec3 across = glm::cross(out, random.direction());
    append_leaf(scene, 0.4f * out, 0.6f * out, 0.25f * across, material);
  }
}

// The triangles that were appended since the last mesh.
void end_mesh(Scene& scene) {
  const auto end = static_cast<std::uint32_t>(scene.indices.size());
  const std::uint32_t first =
      scene.meshes.empty() ? 0 : scene.meshes.back().first_triangle + scene.meshes.back().triangle_count;
  scene.meshes.push_back({first, end - first});
}

glm::mat4x3 random_place(float spread, bool mirrored, Random& random) {
  const glm::vec2 turn = turn_to_circle(random.uniform()), tilt = turn_to_circle(random.uniform());
  const float size = random.uniform(0.3f, 1.0f);
  const glm::vec3 x = glm::vec3{turn.x, 0, -turn.y} * (mirrored ? -size : size);
  const glm::vec3 y = glm::vec3{turn.y * tilt.y, tilt.x, turn.x * tilt.y} * size;
  const glm::vec3 z = glm::vec3{turn.y * tilt.x, -tilt.y, turn.x * tilt.x} * size;
  return {x, y, z, spread * random.in_cube() * glm::vec3{1, 0.4f, 1}};
}

}  // namespace

InstanceTransform rows_of(const glm::mat4x3& t) {
  return {{t[0].x, t[1].x, t[2].x}, t[3].x, {t[0].y, t[1].y, t[2].y}, t[3].y,
          {t[0].z, t[1].z, t[2].z}, t[3].z};
}

std::uint32_t turn_at(const Swarm& swarm, double seconds) {
  const double cycles = seconds / swarm.seconds;
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>((cycles - std::floor(cycles)) * 0x1p32));
}

std::uint64_t instanced_triangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangle_count;
  return count;
}

Scene flattened(Scene scene) {
  if (scene.instances.empty()) return scene;
  const std::uint64_t triangles = instanced_triangles(scene);
  if (3 * triangles > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("scene '" + scene.name + "': its instances have " + std::to_string(triangles) +
                     " triangles, more than one level holds");
  }
  Scene flat;
  flat.positions.reserve(2 * triangles);
  flat.indices.reserve(triangles);
  flat.material_index.reserve(triangles);
  for (const Instance& instance : scene.instances) append_instance(scene, instance, flat);
  scene.positions = std::move(flat.positions);
  scene.indices = std::move(flat.indices);
  scene.material_index = std::move(flat.material_index);
  scene.texcoords = std::move(flat.texcoords);
  scene.texcoord_index = std::move(flat.texcoord_index);
  scene.normals = std::move(flat.normals);
  scene.normal_index = std::move(flat.normal_index);
  scene.meshes.clear();
  scene.instances.clear();
  scene.swarm.reset();
  scene.motion = nullptr;
  return scene;
}

Scene standing_at(const Scene& scene, double seconds) {
  Scene still = scene;
  for (InstancedMesh& mesh : still.meshes) {
    if (!mesh.motion) continue;
    std::ranges::copy(positions_at(*mesh.motion, seconds),
                      still.positions.begin() + static_cast<std::ptrdiff_t>(mesh.first_vertex));
    mesh.motion = nullptr;
  }
  still.motion = nullptr;
  still.swarm.reset();
  if (!scene.motion) return still;
  const std::vector<glm::mat4x3> moved = instances_at(*scene.motion, seconds);
  for (std::size_t i = 0; i < moved.size(); ++i)
    still.instances[scene.motion->moved_instances[i]].transform = moved[i];
  return still;
}

Scene boxes_of_instances(const Scene& scene) {
  std::vector<Bounds> boxes;
  for (const InstancedMesh& mesh : scene.meshes) {
    Bounds box;
    for (std::uint32_t i = 0; i < mesh.triangle_count; ++i) {
      const glm::uvec3 triangle = scene.indices[mesh.first_triangle + i];
      if (!is_active(scene, triangle)) continue;
      for (int corner = 0; corner < 3; ++corner) box.add(scene.positions[triangle[corner]]);
    }
    boxes.push_back(box);
  }
  Scene seen;
  seen.camera = scene.camera;
  for (const Instance& instance : scene.instances) {
    const Bounds& box = boxes[instance.mesh];
    if (box.empty()) continue;
    const auto corner = [&](int i) {
      const glm::dvec3 at{i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                          i & 4 ? box.high.z : box.low.z};
      return moved(instance.transform, glm::vec3(at));
    };
    append_triangle(seen, corner(0), corner(3), corner(5), 0);
    append_triangle(seen, corner(6), corner(1), corner(2), 0);
    append_triangle(seen, corner(7), corner(4), corner(1), 0);
  }
  return seen;
}

std::uint64_t swarm_triangles(std::uint32_t instance_count) {
  const Scene meshes = make_instances(0);
  std::uint64_t triangles = 0;
  for (std::uint32_t mesh = 0; mesh < 3; ++mesh)
    triangles +=
        std::uint64_t{instance_count / 3 + (mesh < instance_count % 3)} * meshes.meshes[mesh].triangle_count;
  return triangles;
}

Scene make_instances(std::uint32_t instance_count) {
  Scene scene;
  scene.name = "instances:" + std::to_string(instance_count);
  scene.materials = {coloured("stone", {0.52f, 0.50f, 0.47f}), coloured("fern", {0.30f, 0.52f, 0.20f}),
                     coloured("box", {0.72f, 0.42f, 0.30f})};
  Random shapes(1), places(2);
  append_rock(scene, glm::vec3{0}, {0.9f, 0.6f, 0.7f}, shapes, 0);
  end_mesh(scene);
  append_bush(scene, shapes, 1);
  end_mesh(scene);
  append_box(scene, 0.6f, 2);
  end_mesh(scene);
  const float spread = 2.0f * std::cbrt(static_cast<float>(instance_count));
  for (std::uint32_t i = 0; i < instance_count; ++i)
    scene.instances.push_back({i % 3, random_place(spread, i % 2 == 1, places)});
  scene.swarm = Swarm{};
  scene.camera = Camera{.position = glm::vec3{0.3f, 0.5f, 1.8f} * (spread + 2.0f)};
  return scene;
}

}  // namespace coppice
