#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interface/ploc.h"
#include "pipeline/trace_plan.h"

namespace coppice {

// What a picture shows.
enum class Show : std::uint32_t {
  color,     // the scene
  steps,     // a heat map of the nodes that each ray visits
  normals,   // of triangles
  depth,     // along the line of sight
  ids,       // of triangles, a colour each
  morton,    // the order of triangles along the Morton curve
  clusters,  // which PLOC has after so many rounds, a colour each
  boxes,     // the scene, and wireframes of the tree's boxes, coloured by their level
  instances  // a colour each; of two levels the primitives of morton, clusters and boxes are these
};

// The name of each, in their order.
inline constexpr std::string_view SHOW_NAMES[] = {"color",  "steps",    "normals", "depth",    "ids",
                                                  "morton", "clusters", "boxes",   "instances"};

constexpr std::string_view name_of(Show show) { return SHOW_NAMES[static_cast<std::uint32_t>(show)]; }

struct ShowOptions {
  Show show = Show::color;
  std::uint32_t most_steps = 0;  // at the end of the map; 0: steps_shown()
  std::uint32_t round = 0;       // of PLOC: rounds that have been done
  std::uint32_t level = 4;       // of boxes: those down to here; the root's is 0
};

// Steps at the end of the map where none are said: the same for every scene, so that pictures compare.
std::uint32_t steps_shown(Walk walk);

// What the kernels show for it, SHOW_.
std::uint32_t kernel_view(Show show);

// "turbo", "viridis", or empty for what has no map.
std::string_view map_name(Show show);

// The map's colours from its beginning on, as linear values of 8-bit sRGB codes. Steps and Morton order:
// turbo (A. Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", 2019), blue to red. Depth:
// viridis (S. van der Walt and N. Smith, 2015), from its yellow end, which is near, to the dark one.
std::array<vec3, SHOW_MAP_COLOURS> colour_map(Show show);
std::array<std::uint8_t, 3> turbo_code(double at);    // sRGB; `at` from 0 to 1
std::array<std::uint8_t, 3> viridis_code(double at);  // the same

// Which values the map spans.
struct ShowSpan {
  float least = 0, greatest = 0;
};

// Of steps, of depths of the scene's box as the film sees it, or of places in the Morton order of so many
// primitives.
ShowSpan span_of(const ShowOptions& options, const Film& film, const Aabb& scene, Walk walk,
                 std::uint32_t primitive_count);
ShowScale scale_of(const ShowSpan& span);

// Each triangle's place in the order; 0 for those that are not in it.
std::vector<uint> ranks_in(std::span<const uint> order, std::uint32_t triangle_count);

// Clusters that PLOC had after so many of its merges, by the tree it made: of each triangle the first
// triangle, in the order of the tree, of its cluster. So a cluster keeps the colour of its first part.
// Inactive triangles are by themselves.
std::vector<uint> clusters_of(std::span<const Node> nodes, std::uint32_t triangle_count,
                              std::uint32_t merges);

// Merges done after so many rounds, as the build left them; all of them beyond the last round.
std::uint32_t merges_after(std::span<const PlocRound> rounds, std::uint32_t active_count,
                           std::uint32_t round);

// Least and greatest value that a picture had; both 0 where there was none.
ShowSpan seen_in(const ShowRange& range, Show show);

// What a view reads, but for values of primitives.
template <class Executor>
void upload_show(Executor& executor, const ShowSlots& slots, Show show, const ShowSpan& span) {
  if (slots.colour_map.count == 0) return;
  const auto map = colour_map(show);
  const ShowScale scale = scale_of(span);
  executor.upload(slots.colour_map, std::span<const vec3>(map));
  executor.upload(slots.scale, std::span<const ShowScale>(&scale, 1));
}

}  // namespace coppice
