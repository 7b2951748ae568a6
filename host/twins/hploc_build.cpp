#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "interface/hploc.h"
#include "twins/normalised.h"
#include "twins/ploc_rounds.h"

namespace coppice::twins {

namespace {

// A complete node of the radix tree: its places and the names of the clusters left of them.
struct RadixNode {
  uint first, last;
  std::vector<uint> names;
};

// What separates a place from the next one: codes first, then places.
std::uint64_t separation(const HplocBuildArgs& args, uint place) {
  std::uint64_t codes = 0;
  for (uint word = args.key_words; word-- > 0;) {
    const uint a = args.keys[std::size_t{place} * args.key_words + word];
    const uint b = args.keys[(std::size_t{place} + 1) * args.key_words + word];
    codes = codes << 32 | (a ^ b);
  }
  // Codes are all different or not at all: their bits come before those of places.
  return codes != 0 ? std::uint64_t{32} + static_cast<uint>(std::bit_width(codes))
                    : static_cast<uint>(std::bit_width(place ^ (place + 1)));
}

class HplocTwin {
 public:
  explicit HplocTwin(const HplocBuildArgs& args)
      : args_(args), count_(args.state[0].active_count), normalise_(args.state[0]), clusters_(count_) {}

  void build() {
    std::vector<RadixNode> open;
    for (uint place = 0; place < count_; ++place) {
      const uint triangle = args_.values[place];
      clusters_[place] = {args_.boxes[triangle].box_min, triangle, args_.boxes[triangle].box_max, 0};
      RadixNode node{place, place, {place}};
      // All open nodes wait for the sibling on their right. This node is one as long as more separates what
      // comes behind it.
      while (!open.empty() &&
             (place + 1 == count_ || separation(args_, node.first - 1) < separation(args_, place))) {
        node = joined(std::move(open.back()), std::move(node));
        open.pop_back();
      }
      open.push_back(std::move(node));
    }
    if (count_ != 0) args_.nodes[0] = clusters_[open[0].names[0]];
  }

 private:
  static bool within_tile(uint first, uint last) { return first / HPLOC_TILE == last / HPLOC_TILE; }

  RadixNode joined(RadixNode left, RadixNode right) {
    const bool root = left.first == 0 && right.last + 1 == count_;
    const bool tile = within_tile(left.first, right.last);
    if (!tile) {
      leave_to_other_tiles(left);
      leave_to_other_tiles(right);
    }
    RadixNode node{left.first, right.last, std::move(left.names)};
    node.names.insert(node.names.end(), right.names.begin(), right.names.end());
    // An LBVH has no more to decide.
    if (root || !tile || args_.cluster_limit == 1) merge(node.names, root ? 1 : args_.cluster_limit);
    return node;
  }

  void leave_to_other_tiles(RadixNode& node) {
    if (within_tile(node.first, node.last)) merge(node.names, args_.cluster_limit);
    publish(node);
  }

  void merge(std::vector<uint>& names, std::size_t target) {
    const bool tall =
        std::ranges::any_of(names, [&](uint name) { return clusters_[name].height >= HPLOC_TALL; });
    bool pair_all = tall;
    while (names.size() > target) {
      const std::size_t before = names.size();
      merge_round(names, pair_all);
      pair_all = tall || (before - names.size()) * HPLOC_SLOW_ROUND < before;
    }
  }

  void publish(const RadixNode& node) {
    for (std::size_t i = 0; i < node.names.size(); ++i) {
      args_.cluster_names[node.first + i] = node.names[i];
      args_.clusters[node.first + i] = clusters_[node.names[i]];
    }
  }

  uint partner(const std::vector<Aabb>& boxes, uint i, bool pair_all) const {
    const auto count = static_cast<uint>(boxes.size());
    if (!pair_all) return nearest_neighbour(boxes.data(), i, count, args_.radius);
    return i % 2 == 1 ? i - 1 : std::min(i + 1, count - 1);
  }

  void merge_round(std::vector<uint>& names, bool pair_all) {
    std::vector<Aabb> boxes;
    for (const uint name : names)
      boxes.push_back({normalise_(clusters_[name].box_min), normalise_(clusters_[name].box_max)});
    std::vector<uint> left;
    for (uint i = 0; i < names.size(); ++i) {
      const uint j = partner(boxes, i, pair_all);
      const bool mutual = j != i && partner(boxes, j, pair_all) == i;
      if (mutual && j < i) continue;
      left.push_back(names[i]);
      if (!mutual) continue;
      const uint children = 2 * names[j] - 1;
      args_.nodes[children] = clusters_[names[i]];
      args_.nodes[children + 1] = clusters_[names[j]];
      clusters_[names[i]] = make_parent(clusters_[names[i]], clusters_[names[j]], children);
    }
    names = std::move(left);
  }

  const HplocBuildArgs& args_;
  const uint count_;
  const Normalisation normalise_;
  std::vector<Node> clusters_;  // by name, the first place of each
};

}  // namespace

void hploc_build(const HplocBuildArgs& args) {
  if (args.state[0].error_word != 0) args.state[0].active_count = 0;
  HplocTwin(args).build();
}

}  // namespace coppice::twins
