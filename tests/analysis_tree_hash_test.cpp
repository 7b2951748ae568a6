#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <vector>

#include "analysis/tree_hash.h"

namespace coppice {
namespace {

TEST(ImageHash, OfNothingIsTheOffsetBasis) { EXPECT_EQ(image_hash({}), 0xcbf29ce484222325u); }

// Words below 256 hash like bytes, for which the reference values of FNV-1a are published.
TEST(ImageHash, AgreesWithThePublishedValuesOfFnv1a) {
  EXPECT_EQ(image_hash(std::vector<std::uint32_t>{'a'}), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(image_hash(std::vector<std::uint32_t>{'f', 'o', 'o', 'b', 'a', 'r'}), 0x85944171f73967e8u);
}

TEST(TreeHash, IsThatOfTheWordsInMemoryOrder) {
  const std::vector<Node> nodes = {{vec3(1, 2, 3), 4, vec3(5, 6, 7), 8}, {vec3(0.5f), 9, vec3(1.5f), 10}};
  std::vector<std::uint32_t> words;
  for (const Node& node : nodes) {
    for (const float x : {node.box_min.x, node.box_min.y, node.box_min.z})
      words.push_back(std::bit_cast<uint>(x));
    words.push_back(node.child);
    for (const float x : {node.box_max.x, node.box_max.y, node.box_max.z})
      words.push_back(std::bit_cast<uint>(x));
    words.push_back(node.height);
  }
  EXPECT_EQ(tree_hash(nodes), image_hash(words));
}

TEST(Hex16, HasSixteenDigits) {
  EXPECT_EQ(hex16(0), "0000000000000000");
  EXPECT_EQ(hex16(0x0123456789abcdefu), "0123456789abcdef");
  EXPECT_EQ(hex16(~std::uint64_t{0}), "ffffffffffffffff");
}

}  // namespace
}  // namespace coppice
