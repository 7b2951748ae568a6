#include <algorithm>
#include <limits>
#include <vector>

#include "interface/shade.h"
#include "twins/film_pixel.h"
#include "twins/shading.h"
#include "twins/trace_counts.h"
#include "twins/wide_packet.h"

namespace coppice::twins {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// A ray of the picture and what it hits.
struct PixelRay {
  uvec2 pixel;
  vec3 direction;
  Hit hit{infinity, NO_TRIANGLE, 0, 0};
};

// The closest hits of a packet's rays. Returns how many nodes it visits.
uint trace_packet(const TracePixelsArgs& args, std::vector<PixelRay>& pixels) {
  if (args.wide_counts[0].node_count == 0) return 0;
  WidePacket packet(args.wide_nodes, args.triangles);
  std::vector<PixelRay*> walking;
  for (PixelRay& pixel : pixels) {
    TraceRay ray(Ray{args.film[0].position, 0, pixel.direction, infinity});
    if (!ray.is_sound) continue;
    ray.approach(args.nodes[0].box_min, args.nodes[0].box_max);
    packet.add(ray, Sight(), ray.prepared(pixel.hit));
    walking.push_back(&pixel);
  }
  const uint visited = packet.trace();
  for (std::size_t k = 0; k < walking.size(); ++k) packet.rays()[k].keep(packet.hits()[k], walking[k]->hit);
  return visited;
}

uint shaded(const TracePixelsArgs& args, const PixelRay& pixel) {
  const uint index = pixel.hit.triangle;
  if (index == NO_TRIANGLE)
    return pixel_of(sky_colour(pixel.direction, args.lighting[0]), args.srgb_thresholds);
  return pixel_of(surface_colour(args.materials[args.material_index[index]], args.triangles[index],
                                 pixel.direction, args.lighting[0]),
                  args.srgb_thresholds);
}

}  // namespace

void trace_pixels(const TracePixelsArgs& args) {
  const Film& film = args.film[0];
  TraceCounters& counters = args.counters[0];
  for (uint first = 0; first < args.ray_count; first += TRACE_PACKET) {
    std::vector<PixelRay> pixels;
    for (uint i = first; i < std::min(first + TRACE_PACKET, args.ray_count); ++i) {
      const uvec2 pixel = film_pixel(args.first_ray + i, film);
      pixels.push_back({pixel, film_direction(film, static_cast<float>(pixel.x) + 0.5f,
                                              static_cast<float>(pixel.y) + 0.5f)});
    }
    const uint steps = trace_packet(args, pixels);
    count_into(counters.rays, pixels.size());
    count_into(counters.steps, std::uint64_t{steps} * pixels.size());
    for (const PixelRay& pixel : pixels) {
      count_into(counters.hits, pixel.hit.triangle != NO_TRIANGLE);
      args.image[pixel.pixel.y * film.width + pixel.pixel.x] = shaded(args, pixel);
    }
  }
}

}  // namespace coppice::twins
