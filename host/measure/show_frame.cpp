#include "measure/show_frame.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "builders/morton_leaves.h"
#include "builders/threads.h"
#include "measure/table.h"

namespace coppice {

namespace {

// A depth in the units of the file.
double shown_value(double value, Show show, const Scene& scene) {
  return show == Show::depth ? std::ldexp(value, -scene.scale_exponent) : value;
}

Json json_of(const ShowSpan& span, Show show, const Scene& scene) {
  return {{"least", shown_value(span.least, show, scene)},
          {"greatest", shown_value(span.greatest, show, scene)}};
}

bool has_range(Show show) { return show == Show::steps || show == Show::depth; }

std::string ends_of_map(Show show) {
  return show == Show::depth ? "yellow (near) to dark blue (far)" : "blue to red";
}

}  // namespace

std::vector<uint> shown_values(const ShowOptions& options, std::span<const Triangle> triangles,
                               std::uint32_t morton_bits, const ShownTree& tree) {
  const auto count = static_cast<std::uint32_t>(triangles.size());
  if (options.show == Show::morton) {
    const MortonLeaves sorted = make_morton_leaves(triangles, morton_bits, Threads(0));
    std::vector<uint> order(sorted.count());
    for (std::size_t place = 0; place < order.size(); ++place) order[place] = sorted.leaf(place).child;
    return ranks_in(order, count);
  }
  if (options.show != Show::clusters) return {};
  const auto active = static_cast<std::uint32_t>((tree.nodes.size() + 1) / 2);
  return clusters_of(tree.nodes, count, merges_after(tree.rounds, active, options.round));
}

std::vector<Triangle> corners_of(std::span<const Aabb> boxes) {
  std::vector<Triangle> corners;
  corners.reserve(boxes.size());
  for (const Aabb& box : boxes) corners.push_back({box.box_min, box.box_max, box.box_max});
  return corners;
}

std::uint64_t count_groups(std::span<const uint> groups, std::span<const Node> nodes) {
  std::vector<uint> words;
  for (const Node& node : nodes) {
    if (node.height == 0) words.push_back(groups[node.child]);
  }
  std::ranges::sort(words);
  return static_cast<std::uint64_t>(std::unique(words.begin(), words.end()) - words.begin());
}

Json to_json(const ShownReport& shown, const Scene& scene) {
  Json json = Json::object();
  if (!map_name(shown.options.show).empty()) json["map"] = map_name(shown.options.show);
  if (has_range(shown.options.show)) {
    json["scale"] = json_of(shown.scale, shown.options.show, scene);
    json["seen"] = json_of(shown.seen, shown.options.show, scene);
  }
  if (shown.options.show == Show::clusters) {
    json["round"] = shown.options.round;
    json["clusters"] = shown.clusters;
  }
  if (shown.options.show == Show::boxes) json["level"] = shown.options.level;
  return json;
}

std::string text_of(const ShownReport& shown, const Scene& scene) {
  const Show show = shown.options.show;
  const std::string name(name_of(show));
  if (has_range(show)) {
    const auto value = [&](float x) { return shown_value(x, show, scene); };
    return format("  show     %s: %s from %.6g to %.6g, %s; seen %.6g to %.6g\n", name.c_str(),
                  std::string(map_name(show)).c_str(), value(shown.scale.least), value(shown.scale.greatest),
                  ends_of_map(show).c_str(), value(shown.seen.least), value(shown.seen.greatest));
  }
  switch (show) {
    case Show::normals:
      return "  show     normals: red, green and blue are x, y and z, dark -1 and bright +1\n";
    case Show::ids:
      return "  show     ids: a colour each triangle\n";
    case Show::instances:
      return format("  show     instances: %zu, a colour each\n", scene.instances.size());
    case Show::morton:
      return "  show     morton: turbo along the curve, blue to red\n";
    case Show::clusters:
      return format("  show     clusters: %llu after round %u, a colour each\n",
                    static_cast<unsigned long long>(shown.clusters), shown.options.round);
    case Show::boxes:
      return format("  show     boxes: levels 0 to %u of the tree, blue to red\n", shown.options.level);
    default:
      return "";
  }
}

}  // namespace coppice
