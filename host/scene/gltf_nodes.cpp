#include "scene/gltf_nodes.h"

namespace coppice {
namespace {

NodeTransform transform_of(const tinygltf::Node& node) {
  NodeTransform transform;
  if (node.matrix.size() == 16) {
    transform.is_matrix = true;
    for (int i = 0; i < 16; ++i) transform.given[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return transform;
  }
  const auto& [t, r, s] = std::tie(node.translation, node.rotation, node.scale);
  if (t.size() == 3) transform.translation = {t[0], t[1], t[2]};
  if (r.size() == 4) transform.rotation = glm::normalize(glm::dquat(r[3], r[0], r[1], r[2]));
  if (s.size() == 3) transform.scale = {s[0], s[1], s[2]};
  return transform;
}

void read_parents(const GltfDocument& document, std::vector<int>& parents) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
      const int child = nodes[i].children[k];
      const std::string pointer = "/nodes/" + std::to_string(i) + "/children/" + std::to_string(k);
      document.check_index(pointer, child, nodes.size(), "nodes");
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0) {
        document.fail(pointer, "node " + std::to_string(child) + " is a child of node " +
                                   std::to_string(parent) + " already, expected one parent a node");
      }
      parent = static_cast<int>(i);
    }
  }
}

// The nodes from these roots down, depth first.
std::vector<std::uint32_t> below(const std::vector<tinygltf::Node>& nodes, const std::vector<int>& roots) {
  std::vector<std::uint32_t> order;
  std::vector<int> pending(roots.rbegin(), roots.rend());
  while (!pending.empty()) {
    const int node = pending.back();
    pending.pop_back();
    order.push_back(static_cast<std::uint32_t>(node));
    const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
    pending.insert(pending.end(), children.rbegin(), children.rend());
  }
  return order;
}

std::vector<int> roots_of_scene(const GltfDocument& document, const std::vector<int>& parents) {
  const tinygltf::Model& model = document.model;
  if (model.defaultScene >= 0)
    document.check_index("/scene", model.defaultScene, model.scenes.size(), "scenes");
  const auto scene = static_cast<std::size_t>(std::max(model.defaultScene, 0));
  const std::vector<int>& roots = model.scenes[scene].nodes;
  std::vector<bool> is_listed(parents.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const std::string pointer = "/scenes/" + std::to_string(scene) + "/nodes/" + std::to_string(i);
    document.check_index(pointer, roots[i], parents.size(), "nodes");
    const auto root = static_cast<std::size_t>(roots[i]);
    if (parents[root] >= 0) {
      document.fail(pointer, "node " + std::to_string(roots[i]) + " is a child of node " +
                                 std::to_string(parents[root]) + ", expected a node without a parent");
    }
    if (is_listed[root])
      document.fail(pointer, "node " + std::to_string(roots[i]) + " twice, expected it once");
    is_listed[root] = true;
  }
  return roots;
}

}  // namespace

GltfNodes read_gltf_nodes(const GltfDocument& document) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  GltfNodes result;
  result.parents.assign(nodes.size(), -1);
  for (const tinygltf::Node& node : nodes) result.transforms.push_back(transform_of(node));
  read_parents(document, result.parents);
  std::vector<int> roots;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (result.parents[i] < 0) roots.push_back(static_cast<int>(i));
  }
  result.order = below(nodes, roots);
  if (result.order.size() != nodes.size()) {  // as every node has at most one parent, the others go round
    std::vector<bool> is_below(nodes.size());
    for (const std::uint32_t node : result.order) is_below[node] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!is_below[i]) {
        document.fail("/nodes/" + std::to_string(i) + "/children",
                      "the node is below itself (a cycle), expected a tree");
      }
    }
  }
  const bool has_scenes = !document.model.scenes.empty() || document.model.defaultScene >= 0;
  result.drawn = has_scenes ? below(nodes, roots_of_scene(document, result.parents)) : result.order;
  return result;
}

}  // namespace coppice
