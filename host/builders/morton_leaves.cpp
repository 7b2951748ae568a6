#include "builders/morton_leaves.h"

#include "builders/leaves.h"
#include "builders/morton_order.h"
#include "builders/threads.h"

namespace coppice {

MortonLeaves make_morton_leaves(std::span<const Triangle> triangles, std::uint32_t morton_bits,
                                const Threads& threads) {
  constexpr std::size_t chunk_size = 1 << 14;
  std::vector<Node> leaves = make_leaves(triangles, threads);
  if (leaves.empty()) return {{}, {}, {}, NormalisedSpace(Aabb{vec3(0), vec3(0)})};
  const Aabb scene = bounds_of(leaves, threads);
  const NormalisedSpace to_normalised(scene);
  const MortonGrid grid(to_normalised(scene), static_cast<int>(morton_bits) / 3);
  std::vector<std::uint64_t> codes(leaves.size());
  threads.for_each_chunk(leaves.size(), chunk_size, [&](Chunk chunk, std::size_t) {
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      codes[i] = grid.code_of(to_normalised(Aabb{leaves[i].box_min, leaves[i].box_max}));
    }
  });
  std::vector<std::uint32_t> order = sorted_order(codes, static_cast<int>(morton_bits), threads);
  return {std::move(leaves), std::move(codes), std::move(order), to_normalised};
}

}  // namespace coppice
