#include "builders/leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "builders/threads.h"

namespace coppice {
namespace {

constexpr std::size_t LEAVES_CHUNK = 1 << 14;

const Aabb EMPTY_BOX = {vec3(std::numeric_limits<float>::infinity()),
                        vec3(-std::numeric_limits<float>::infinity())};

}  // namespace

bool is_active(const Triangle& triangle) {
  // One bit for each coordinate and no branch: almost every triangle is active.
  bool finite = true;
  for (const vec3& corner : {triangle.a, triangle.b, triangle.c}) {
    for (int axis = 0; axis < 3; ++axis) {
      finite &= std::abs(corner[axis]) <= std::numeric_limits<float>::max();
    }
  }
  return finite;
}

Aabb triangle_box(const Triangle& triangle) {
  return {glm::min(glm::min(triangle.a, triangle.b), triangle.c),
          glm::max(glm::max(triangle.a, triangle.b), triangle.c)};
}

std::vector<Node> make_leaves(std::span<const Triangle> triangles) {
  return make_leaves(triangles, Threads(1));
}

std::vector<Node> make_leaves(std::span<const Triangle> triangles, const Threads& threads) {
  if (triangles.size() > std::size_t{1} << 31) throw std::length_error("more than 2^31 triangles");
  std::vector<Node> leaves(triangles.size());
  // Each chunk puts its leaves to where they are if every triangle before is active; mostly that is final.
  std::vector<std::size_t> counts(chunk_count(triangles.size(), LEAVES_CHUNK));
  threads.for_each_chunk(triangles.size(), LEAVES_CHUNK, [&](Chunk chunk, std::size_t k) {
    std::size_t next = chunk.begin;
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      if (!is_active(triangles[i])) continue;
      const Aabb box = triangle_box(triangles[i]);
      leaves[next++] = {box.box_min, static_cast<std::uint32_t>(i), box.box_max, 0};
    }
    counts[k] = next - chunk.begin;
  });
  std::size_t active_count = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const auto first = leaves.begin() + static_cast<std::ptrdiff_t>(k * LEAVES_CHUNK);
    const auto place = leaves.begin() + static_cast<std::ptrdiff_t>(active_count);
    if (place != first) std::copy(first, first + static_cast<std::ptrdiff_t>(counts[k]), place);
    active_count += counts[k];
  }
  leaves.resize(active_count);
  return leaves;
}

Aabb bounds_of(std::span<const Node> nodes) {
  Aabb bounds = EMPTY_BOX;
  for (const Node& node : nodes) bounds = box_union(bounds, {node.box_min, node.box_max});
  return bounds;
}

Aabb bounds_of(std::span<const Node> nodes, const Threads& threads) {
  std::vector<Aabb> bounds(chunk_count(nodes.size(), LEAVES_CHUNK));
  threads.for_each_chunk(nodes.size(), LEAVES_CHUNK, [&](Chunk chunk, std::size_t k) {
    bounds[k] = bounds_of(nodes.subspan(chunk.begin, chunk.count()));
  });
  Aabb all = EMPTY_BOX;
  for (const Aabb& box : bounds) all = box_union(all, box);
  return all;
}

}  // namespace coppice
