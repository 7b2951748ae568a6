#include "builders/hploc.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "builders/morton_leaves.h"
#include "builders/subtree.h"
#include "builders/threads.h"
#include "interface/hploc.h"
#include "interface/ploc.h"

namespace coppice {
namespace {

// A cluster is named by the first place along the curve that it took.
struct Cluster {
  std::uint32_t name;
  Node node;  // in world units
  Aabb box;   // in normalised space
};

float half_area_of_union(const Aabb& a, const Aabb& b) {
  const Aabb both = box_union(a, b);
  const vec3 extent = both.box_max - both.box_min;
  return (extent.x * extent.y + extent.y * extent.z) + extent.z * extent.x;
}

class Hploc {
 public:
  Hploc(const MortonLeaves& leaves, std::uint32_t radius, std::vector<Node>& nodes)
      : leaves_(leaves), radius_(radius), nodes_(nodes) {}

  void build() { nodes_[0] = merged(clusters_of(0, leaves_.count()), 1)[0].node; }

 private:
  using Clusters = std::vector<Cluster>;

  // The radix tree splits a range where the highest bit changes that is not the same in all its codes; equal
  // codes count by their places.
  std::size_t split_of(std::size_t begin, std::size_t end) const {
    const bool equal = leaves_.code(begin) == leaves_.code(end - 1);
    const auto key = [&](std::size_t place) -> std::uint64_t { return equal ? place : leaves_.code(place); };
    const std::uint64_t bit = std::bit_floor(key(begin) ^ key(end - 1));
    std::size_t low = begin, high = end - 1;  // without the bit, with it
    while (high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      (key(middle) & bit ? high : low) = middle;
    }
    return high;
  }

  // Of the places from begin to end: those of both children, not merged yet.
  Clusters clusters_of(std::size_t begin, std::size_t end) {
    if (end - begin == 1) {
      const Node& leaf = leaves_.leaf(begin);
      const Aabb box = leaves_.to_normalised(Aabb{leaf.box_min, leaf.box_max});
      return {{static_cast<std::uint32_t>(begin), leaf, box}};
    }
    const std::size_t split = split_of(begin, end);
    const bool within_tile = begin / HPLOC_TILE == (end - 1) / HPLOC_TILE;
    const std::size_t most = within_tile ? HPLOC_TILE : HPLOC_CLUSTERS;
    Clusters clusters = merged(clusters_of(begin, split), most);
    const Clusters right = merged(clusters_of(split, end), most);
    clusters.insert(clusters.end(), right.begin(), right.end());
    return clusters;
  }

  Clusters merged(Clusters clusters, std::size_t most) {
    const bool tall =
        std::ranges::any_of(clusters, [](const Cluster& c) { return c.node.height >= HPLOC_TALL; });
    bool pairs_all = tall;
    while (clusters.size() > most) {
      std::vector<std::size_t> partner(clusters.size());
      if (pairs_all) {
        for (std::size_t i = 0; i < partner.size(); ++i) partner[i] = std::min(i ^ 1, partner.size() - 1);
      } else {
        find_nearest(clusters, partner);
      }
      const std::size_t before = clusters.size();
      clusters = merge_mutual(clusters, partner);
      pairs_all = tall || (before - clusters.size()) * HPLOC_SLOW_ROUND < before;
    }
    return clusters;
  }

  // Gap by gap from the least; of two pairs with the same gap and area that with the gap's lowest set bit
  // clear in its lower index.
  void find_nearest(const Clusters& clusters, std::vector<std::size_t>& nearest) const {
    const std::size_t count = clusters.size();
    constexpr float none = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const auto area_to = [&](std::size_t j) {
        return j < count ? half_area_of_union(clusters[i].box, clusters[j].box) : none;
      };
      float least = none;
      for (std::size_t gap = 1; gap <= radius_ && gap < count; ++gap) {
        const float left = area_to(i - gap), right = area_to(i + gap);  // i - gap may wrap: then beyond count
        const bool right_is_first = (i & (gap & (~gap + 1))) == 0;
        const bool takes_right = right < left || (right == left && right_is_first);
        const float area = takes_right ? right : left;
        if (area < least) {
          least = area;
          nearest[i] = takes_right ? i + gap : i - gap;
        }
      }
    }
  }

  // Of a pair the first cluster stays; the name of the second tells where the children stand.
  Clusters merge_mutual(const Clusters& clusters, const std::vector<std::size_t>& partner) {
    Clusters left;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const std::size_t j = partner[i];
      if (j == i || partner[j] != i)
        left.push_back(clusters[i]);
      else if (i < j)
        left.push_back(parent_of(clusters[i], clusters[j]));
    }
    return left;
  }

  Cluster parent_of(const Cluster& first, const Cluster& second) {
    Cluster parent{first.name, {}, box_union(first.box, second.box)};
    parent.node.child = 2 * second.name - 1;
    nodes_[parent.node.child] = first.node;
    nodes_[parent.node.child + 1] = second.node;
    fit_to_children(parent.node, nodes_);
    return parent;
  }

  const MortonLeaves& leaves_;
  const std::size_t radius_;
  std::vector<Node>& nodes_;
};

}  // namespace

Bvh build_hploc(std::span<const Triangle> triangles, const HplocConfig& config) {
  if (config.radius < 1 || config.radius > PLOC_MAX_RADIUS) {
    throw std::invalid_argument("H-PLOC radius " + std::to_string(config.radius) + " is not in 1 to " +
                                std::to_string(PLOC_MAX_RADIUS));
  }
  if (config.morton_bits != 30 && config.morton_bits != 60) {
    throw std::invalid_argument("Morton codes of " + std::to_string(config.morton_bits) +
                                " bits: there are 30 and 60");
  }
  const MortonLeaves leaves = make_morton_leaves(triangles, config.morton_bits, Threads(1));
  Bvh bvh;
  bvh.active_count = static_cast<std::uint32_t>(leaves.count());
  if (leaves.count() == 0) return bvh;
  bvh.nodes.resize(2 * leaves.count() - 1);
  Hploc(leaves, config.radius, bvh.nodes).build();
  return bvh;
}

}  // namespace coppice
