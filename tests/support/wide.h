#pragma once

#include <glm/common.hpp>
#include <span>
#include <vector>

#include "pipeline/wide_plan.h"
#include "stages/cpu_executor.h"

namespace coppice {

// A tree of a builder on the host in the slots of plan_tree, with room for its wide nodes.
struct UploadedTree {
  TreeSlots tree;
  WidePlan wide;
};

inline UploadedTree plan_uploaded(Layout& layout, std::span<const Node> nodes,
                                  std::uint32_t max_turns = 0xffffffffu) {
  UploadedTree uploaded;
  uploaded.tree = plan_tree(layout, static_cast<std::uint32_t>((nodes.size() + 1) / 2), nodes.size());
  uploaded.wide = plan_wide(layout, uploaded.tree, nullptr, max_turns);
  return uploaded;
}

template <class Executor>
void upload_tree(Executor& executor, const TreeSlots& tree, std::span<const Node> nodes) {
  executor.upload(tree.nodes, nodes);
  BuildState state{};
  state.active_count = static_cast<uint>((nodes.size() + 1) / 2);
  executor.upload(tree.state, std::span<const BuildState>(&state, 1));
}

// What the twins make of a tree; by the way, the error word of their run.
inline std::vector<WideNode> widen_by_twins(std::span<const Node> nodes, uint* error_word = nullptr) {
  Layout layout;
  const UploadedTree uploaded = plan_uploaded(layout, nodes);
  CpuExecutor executor(layout);
  upload_tree(executor, uploaded.tree, nodes);
  Chain chain = executor.chain();
  append_wide(chain, uploaded.tree, uploaded.wide);
  executor.run(chain.steps());
  if (error_word) *error_word = executor.read(uploaded.tree.state)[0].error_word;
  return executor.read(
      Slot<WideNode>{uploaded.tree.wide_nodes.place, executor.read(uploaded.tree.wide_counts)[0].node_count});
}

// A tree over `leaves` leaves, all in one chain: each internal node has a leaf as its first child.
inline std::vector<Node> chain_of_leaves(uint leaves) {
  std::vector<Node> nodes(2 * std::size_t{leaves} - 1);
  const auto leaf = [](uint triangle) {
    const vec3 corner(static_cast<float>(triangle), 0, 0);
    return Node{corner, triangle, corner + 1.0f, 0};
  };
  std::size_t bottom = nodes.size() - 1;
  nodes[bottom] = leaf(leaves - 1);
  for (uint triangle = leaves - 1; triangle-- > 0;) {
    const std::size_t pair = 2 * std::size_t{triangle} + 1;
    nodes[pair] = leaf(triangle);
    const Node first = nodes[pair], second = nodes[pair + 1];
    nodes[pair - 1] = {glm::min(first.box_min, second.box_min), static_cast<uint>(pair),
                       glm::max(first.box_max, second.box_max), second.height + 1};
  }
  return nodes;
}

// A chain of so many leaves, below which the tree stands.
inline std::vector<Node> below_a_chain(std::span<const Node> tree, uint leaves) {
  const uint moved = 2 * leaves;
  std::vector<Node> nodes(moved + tree.size());
  for (std::size_t i = 0; i < tree.size(); ++i) {
    nodes[moved + i] = tree[i];
    if (tree[i].height > 0) nodes[moved + i].child += moved;
  }
  const auto triangles = static_cast<uint>((tree.size() + 1) / 2);
  for (uint leaf = leaves; leaf-- > 0;) {
    const Node& below = nodes[2 * leaf + 2];
    const vec3 corner = below.box_max + vec3(1);
    nodes[2 * leaf + 1] = {corner, triangles + leaf, corner + 1.0f, 0};
    nodes[2 * leaf] = {below.box_min, 2 * leaf + 1, corner + 1.0f, below.height + 1};
  }
  return nodes;
}

}  // namespace coppice
