#include "twins/wide_levels.h"

#include <algorithm>
#include <vector>

#include "twins/normalised.h"

namespace coppice::twins {

namespace {

uint divided_up(uint count, uint size) { return count / size + (count % size != 0); }

bool is_leaf(uint child) { return child >= WIDE_LEAF; }

uint word_of(Address<const Node> nodes, uint index) {
  return nodes[index].height == 0 ? index + WIDE_LEAF : index;
}

}  // namespace

std::array<uint, WIDE_CHILDREN> wide_children(Address<const Node> nodes, uint root) {
  const Normalisation normalise(Aabb{nodes[0].box_min, nodes[0].box_max});
  const auto area = [&](uint child) {
    const Aabb box{normalise(nodes[child].box_min), normalise(nodes[child].box_max)};
    return union_area(box, box);
  };
  const float whole = area(root);
  // Small children last, as if they had a negative area.
  const auto weighted_area = [&](uint child) {
    const float weights[] = {0, WIDE_HEIGHT_1_WEIGHT, WIDE_HEIGHT_2_WEIGHT};
    const uint height = nodes[child].height;
    if (height <= WIDE_LOW_HEIGHT) return weights[height] * area(child);
    return area(child) * WIDE_SMALL_PARTS < whole ? -1.0f : area(child);
  };
  std::vector<uint> children = {word_of(nodes, root)};
  while (children.size() < WIDE_CHILDREN) {
    auto widest = children.end();
    for (auto child = children.begin(); child != children.end(); ++child) {
      if (!is_leaf(*child) && (widest == children.end() || weighted_area(*child) > weighted_area(*widest)))
        widest = child;
    }
    if (widest == children.end()) break;
    if (children.size() >= WIDE_LEAST_CHILDREN && weighted_area(*widest) < 0) break;
    const uint pair = nodes[*widest].child;
    *widest = word_of(nodes, pair);
    children.push_back(word_of(nodes, pair + 1));
  }
  std::array<uint, WIDE_CHILDREN> padded;
  padded.fill(WIDE_EMPTY);
  std::ranges::copy(children, padded.begin());
  return padded;
}

WideLevel make_level(uint first, uint count, uint first_tile, uint first_block) {
  WideLevel level{first, count, first_tile, first_block, {}, 0};
  level.groups = rows_of_groups(tile_count(level));
  return level;
}

uint tile_count(const WideLevel& level) { return divided_up(level.count, WIDE_TILE); }

uvec3 rows_of_groups(uint groups) {
  if (groups == 0) return uvec3(0);
  const uint rows = divided_up(groups, 65535);
  return {divided_up(groups, rows), rows, 1};
}

void enter_wide_node(const WideCollapseArgs& args, const WideLevel& level, uint index, uint root,
                     uint parent) {
  const auto children = wide_children(args.nodes, root);
  const auto child_count =
      static_cast<uint>(std::ranges::count_if(children, [](uint c) { return !is_leaf(c); }));
  const uint entry = level.first + index;
  std::ranges::copy(children, &args.children[std::size_t{entry} * WIDE_CHILDREN]);
  args.entries[entry] = {root, parent, 0, child_count};
  args.tile_sums[level.first_tile + index / WIDE_TILE] += child_count;
  args.block_sums[level.first_block + index / WIDE_TILE / WIDE_BLOCK] += child_count;
}

}  // namespace coppice::twins
