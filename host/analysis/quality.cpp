#include "analysis/quality.h"

#include <algorithm>
#include <glm/ext/vector_double3.hpp>
#include <vector>

namespace coppice {
namespace {

double half_area(const Node& node) {
  if (node.box_min.x > node.box_max.x) return 0;  // NOTHING_BOX
  const glm::dvec3 extent = glm::dvec3(node.box_max) - glm::dvec3(node.box_min);
  return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

struct NodeAtDepth {
  std::uint32_t node;
  std::uint32_t depth;
};

}  // namespace

TreeQuality measure_quality(std::span<const Node> nodes) {
  TreeQuality quality;
  if (nodes.empty()) return quality;
  const double root_area = half_area(nodes[0]);
  std::vector<NodeAtDepth> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [index, depth] = stack.back();
    stack.pop_back();
    const Node& node = nodes[index];
    ++quality.nodes;
    quality.sah += root_area > 0.0 ? half_area(node) / root_area : 1.0;
    if (node.height == 0) {
      ++quality.leaves;
      ++quality.references;
      quality.depth = std::max(quality.depth, depth);
    } else {
      stack.push_back({node.child + 1, depth + 1});
      stack.push_back({node.child, depth + 1});
    }
  }
  return quality;
}

}  // namespace coppice
