#include "pipeline/check_inputs.h"

#include <limits>

namespace coppice {

std::vector<uint> random_words(std::size_t count) {
  CheckRandom random;
  std::vector<uint> words(count);
  for (uint& word : words) word = random.next_word() ^ random.next_word() >> 16;
  return words;
}

std::vector<Triangle> scattered_triangles(std::uint32_t count) {
  CheckRandom random;
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    t.a = random.next_vec3();
    t.b = t.a + random.next_vec3() * 0.01f;
    t.c = t.a + random.next_vec3() * 0.01f;
  }
  return triangles;
}

std::vector<Node> chain_of_boxes(std::uint32_t count) {
  const std::uint32_t last = count - 1;
  // All boxes from this one on.
  const auto rest = [=](std::uint32_t box) {
    const auto first = static_cast<float>(box);
    return Node{
        {first, 0, 0}, box == last ? box : 2 * box + 1, {static_cast<float>(count), 1, 1}, last - box};
  };
  std::vector<Node> nodes = {rest(0)};
  for (std::uint32_t box = 0; box < last; ++box) {
    const auto first = static_cast<float>(box);
    nodes.push_back({{first, 0, 0}, box, {first + 1, 1, 1}, 0});
    nodes.push_back(rest(box + 1));
  }
  return nodes;
}

std::vector<Ray> check_rays() {
  constexpr std::uint32_t picture_edge = 16, other_rays = 64;
  constexpr float far = std::numeric_limits<float>::infinity();
  CheckRandom random;
  std::vector<Ray> rays;
  for (std::uint32_t y = 0; y < picture_edge; ++y) {
    for (std::uint32_t x = 0; x < picture_edge; ++x) {
      const vec3 through = {static_cast<float>(x) / picture_edge, static_cast<float>(y) / picture_edge, 0};
      rays.push_back({{0.5f, 0.5f, -1}, 0, through - vec3(0.5f, 0.5f, -1), far});
    }
  }
  for (std::uint32_t i = 0; i < other_rays; ++i) {
    const vec3 origin = random.next_vec3();
    rays.push_back({origin, 0, random.next_vec3() - vec3(0.5f), far});
  }
  return rays;
}

}  // namespace coppice
