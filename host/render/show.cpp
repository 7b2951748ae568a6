#include "render/show.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace coppice {

namespace {

using Polynomial = std::array<double, 7>;  // coefficients, the constant first

std::uint8_t code_at(const Polynomial& polynomial, double at) {
  double value = 0;
  for (auto coefficient = polynomial.rbegin(); coefficient != polynomial.rend(); ++coefficient)
    value = value * at + *coefficient;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

std::array<std::uint8_t, 3> codes_at(const std::array<Polynomial, 3>& map, double at) {
  return {code_at(map[0], at), code_at(map[1], at), code_at(map[2], at)};
}

float linear_of(std::uint8_t code) {
  const double encoded = code / 255.0;
  return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

vec3 forward_of(const Film& film) {
  return film.corner + film.right * (0.5f * static_cast<float>(film.width)) +
         film.down * (0.5f * static_cast<float>(film.height));
}

ShowSpan depths_of(const Film& film, const Aabb& box) {
  const glm::dvec3 forward{forward_of(film)};
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 from_eye;
    for (int axis = 0; axis < 3; ++axis) {
      const float at = corner >> axis & 1 ? box.box_max[axis] : box.box_min[axis];
      from_eye[axis] = double{at} - film.position[axis];
    }
    const double depth = std::max(glm::dot(from_eye, forward), 0.0);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  return {static_cast<float>(nearest), static_cast<float>(farthest)};
}

}  // namespace

std::uint32_t steps_shown(Walk walk) { return is_wide(walk) ? 64 : 128; }

std::uint32_t kernel_view(Show show) {
  static constexpr std::uint32_t views[] = {SHOW_COLOR, SHOW_STEPS,  SHOW_NORMALS, SHOW_DEPTH,    SHOW_IDS,
                                            SHOW_RANKS, SHOW_GROUPS, SHOW_COLOR,   SHOW_INSTANCES};
  return views[static_cast<std::uint32_t>(show)];
}

std::string_view map_name(Show show) {
  if (show == Show::depth) return "viridis";
  return show == Show::steps || show == Show::morton || show == Show::boxes ? "turbo" : "";
}

// The polynomial of R. Du for the table of A. Mikhailov.
std::array<std::uint8_t, 3> turbo_code(double at) {
  static constexpr std::array<Polynomial, 3> map = {
      {{0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943, 0},
       {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604, 0},
       {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973, 0}}};
  return codes_at(map, at);
}

// The polynomial of M. Zucker for the table of S. van der Walt and N. Smith.
std::array<std::uint8_t, 3> viridis_code(double at) {
  static constexpr std::array<Polynomial, 3> map = {
      {{0.2777273272, 0.1050930431, -0.3308618287, -4.6342304990, 6.2282699363, 4.7763849977, -5.4354558559},
       {0.0054073445, 1.4046135299, 0.2148475595, -5.7991009734, 14.1799333668, -13.7451453777, 4.6458526122},
       {0.3340998053, 1.3845901626, 0.0950951630, -19.3324409563, 56.6905526007, -65.3530326334,
        26.3124352496}}};
  return codes_at(map, at);
}

std::array<vec3, SHOW_MAP_COLOURS> colour_map(Show show) {
  std::array<vec3, SHOW_MAP_COLOURS> map;
  for (std::uint32_t i = 0; i < SHOW_MAP_COLOURS; ++i) {
    const double at = i / double{SHOW_MAP_COLOURS - 1};
    const auto code = show == Show::depth ? viridis_code(1 - at) : turbo_code(at);
    map[i] = {linear_of(code[0]), linear_of(code[1]), linear_of(code[2])};
  }
  return map;
}

ShowSpan span_of(const ShowOptions& options, const Film& film, const Aabb& scene, Walk walk,
                 std::uint32_t primitive_count) {
  switch (options.show) {
    case Show::steps:
      return {0, static_cast<float>(options.most_steps ? options.most_steps : steps_shown(walk))};
    case Show::depth:
      return depths_of(film, scene);
    case Show::morton:
      return {0, static_cast<float>(primitive_count)};
    default:
      return {};
  }
}

ShowScale scale_of(const ShowSpan& span) {
  const float per_unit = static_cast<float>(SHOW_MAP_COLOURS) / (span.greatest - span.least);
  return {span.least, std::isfinite(per_unit) && per_unit > 0 ? per_unit : 0, 0, 0};
}

std::vector<uint> ranks_in(std::span<const uint> order, std::uint32_t triangle_count) {
  std::vector<uint> ranks(triangle_count, 0);
  for (std::size_t place = 0; place < order.size(); ++place)
    ranks.at(order[place]) = static_cast<uint>(place);
  return ranks;
}

// The pairs of siblings fill the nodes from the back, the first merge at the end.
std::vector<uint> clusters_of(std::span<const Node> nodes, std::uint32_t triangle_count,
                              std::uint32_t merges) {
  std::vector<uint> clusters(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i) clusters[i] = i;
  if (nodes.empty()) return clusters;
  const std::size_t first_merged = nodes.size() - 2 * std::size_t{merges};
  constexpr uint none = ~0u;
  struct Visit {
    uint node, cluster;  // `none` above all clusters
  };
  const auto first_triangle = [&](uint node) {
    while (nodes[node].height != 0) node = nodes[node].child;
    return nodes[node].child;
  };
  for (std::vector<Visit> stack = {{0, none}}; !stack.empty();) {
    Visit visit = stack.back();
    stack.pop_back();
    const Node& node = nodes[visit.node];
    if (node.height == 0) {
      if (visit.cluster != none) clusters.at(node.child) = visit.cluster;
      continue;
    }
    if (visit.cluster == none && node.child >= first_merged) visit.cluster = first_triangle(visit.node);
    stack.push_back({node.child, visit.cluster});
    stack.push_back({node.child + 1, visit.cluster});
  }
  return clusters;
}

std::uint32_t merges_after(std::span<const PlocRound> rounds, std::uint32_t active_count,
                           std::uint32_t round) {
  const std::uint32_t all = active_count == 0 ? 0 : active_count - 1;
  if (round == 0) return 0;
  if (round >= rounds.size() || rounds[round].cluster_count == 0) return all;
  return rounds[round].merged_before;
}

ShowSpan seen_in(const ShowRange& range, Show show) {
  if (range.least_complement == 0 && range.greatest == 0) return {};
  const uint least = ~range.least_complement;
  if (show == Show::depth) return {std::bit_cast<float>(least), std::bit_cast<float>(range.greatest)};
  return {static_cast<float>(least), static_cast<float>(range.greatest)};
}

}  // namespace coppice
