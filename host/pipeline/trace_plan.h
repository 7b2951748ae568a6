#pragma once

#include <array>
#include <cstdint>

#include "interface/show.h"
#include "pipeline/build_plan.h"
#include "pipeline/lights.h"
#include "pipeline/paths.h"
#include "pipeline/ray_filter.h"
#include "pipeline/refine.h"
#include "pipeline/textures.h"
#include "pipeline/walk.h"

namespace coppice {

// What is made of radiance before it becomes sRGB: see docs/effects.md#tone-mapping.
struct ToneMapping {
  std::uint32_t curve = TONE_NONE;
  double stops = 0;  // of exposure: radiance is multiplied by 2 to this power

  float exposure() const;
  bool changes() const { return curve != TONE_NONE || exposure() != 1; }
};

inline constexpr const char* TONE_CURVE_NAMES[] = {"none", "reinhard", "aces"};  // by TONE_

struct TraceOptions {
  std::uint32_t width = 1024, height = 768;  // pixels
  std::uint32_t samples = 1;                 // per pixel
  Walk walk = Walk::binary;  // wide ones need the slots of the wide tree, watertight and robust
  // Turns of the traversal loop and pairs of nodes it visits a turn; fewer turns than nodes only where a
  // driver ends long loops by itself.
  std::uint32_t max_turns = 0xffffffffu;
  std::uint32_t visits_per_turn = 1;
  // Entries of the traversal stack; a tree that is higher is refused by name.
  std::uint32_t stack_entries = TRACE_STACK_LIMIT;
  std::uint32_t triangle_test = TRIANGLE_WATERTIGHT;
  std::uint32_t box_test = BOX_ROBUST;
  bool directional_light = true;    // what the scene calls for
  LightCounts lights{};             // of colours
  TextureCounts textures{};         // of colours
  bool lens = false;                // of colours: rays go through that of the film
  PathCounts paths{};               // of colours
  AlphaCounts alpha{};              // of colours; not by brute force
  std::uint32_t show = SHOW_COLOR;  // SHOW_; brute force has no steps
  bool keep_hits = false;           // the rays of the last sample and their hits are asked for
  ToneMapping tone{};               // of colours
  bool keep_radiance = false;       // that of the whole picture is asked for, 12 bytes a pixel
  // Of a picture that is refined by and by. The samples of a pixel are taken from `first_sample` to
  // `samples`, and added to those before it.
  bool keep_noise = false;         // and how far samples are apart, as much again; each is shaded by itself
  bool adaptive = false;           // some pixels have more samples than others, for 16 bytes a pixel
  std::uint32_t first_sample = 0;  // of those before it radiance is kept
  bool resolves = true;            // pixels are made of the last sample
};

// Whether the wide tree can be walked: its tracers have the watertight and the robust test only, so that the
// order of visits does not show.
bool can_trace_wide(const TraceOptions& options);

// Whether samples or lights are added up before they are pixels, what they see is not colour, rays are not
// those of pixels' centres, tones are mapped, or radiance is asked for.
bool keeps_radiance(const TraceOptions& options);

// Whether it is kept of the whole picture, not of a band.
bool keeps_whole_radiance(const TraceOptions& options);

// Whether each ray becomes a pixel at once (trace_pixels): of packets through the wide tree, where neither
// rays nor hits nor radiance are kept.
bool traces_pixels(const TraceOptions& options);

// Rays, and what they hit: closest hits so far on the way in, t_max and NO_TRIANGLE where there is none yet.
struct RaySlots {
  Slot<Ray> rays;
  Slot<Hit> hits;
  Slot<TraceCounters> counters;
  RayFilter filter{};
  Slot<uint> ray_steps{};  // out: of each, where there is a slot; not by brute force
};

// What the counters of a trace say.
struct TraceCounts {
  std::uint64_t rays = 0, hits = 0, steps = 0;
};
TraceCounts counts_of(const TraceCounters& counters);

// What is shown in place of colours: empty slots where nothing is.
struct ShowSlots {
  Slot<vec3> colour_map;        // in: SHOW_MAP_COLOURS of them
  Slot<ShowScale> scale;        // in
  Slot<uint> primitive_values;  // in: one a primitive, for SHOW_RANKS and SHOW_GROUPS
  Slot<ShowRange> range;        // out
};

// Where a trace of a picture keeps what, beside the tree it walks. Rays and hits are empty where pixels are
// traced.
struct TracePlan : RaySlots {
  TraceOptions options;
  std::uint32_t band_rays;  // the image is traced in bands of at most so many rays

  Slot<uint> material_index;        // in: one a triangle
  Slot<SurfaceMaterial> materials;  // in
  Slot<Film> film;                  // in
  Slot<Lighting> lighting;          // in
  Slot<uint> srgb_thresholds;       // in: see srgb_thresholds()
  Slot<uint> image;                 // out: RGBA8, red in the low byte, rows top to bottom

  // Summed over the samples, in the order of FILM_STRIP: one a ray of the band, or a pixel of the picture
  // where that is asked for; none where none is kept.
  Slot<vec3> radiance;
  NoiseSlots noise;
  Slot<uint> traced_pixels;  // only these of the picture, by their places; empty: all
  LightSlots lights;
  TextureSlots textures;
  PathSlots paths;
  ShowSlots show;
};

// Of rays to lights, whichever way hits are shaded; none: there are none.
const Slot<TraceCounters>& shadow_counters(const TracePlan& plan);

// Throws LayoutError if a slot does not fit a block, std::invalid_argument for the steps of brute force.
TracePlan plan_trace(Layout& layout, const TreeSlots& tree, std::uint32_t material_count,
                     const TraceOptions& options);

// The same picture, of colours, refined by and by: what it keeps beside what `plan` keeps. All else they
// share, so that only one of them is traced at a time.
TracePlan plan_refined(Layout& layout, const TracePlan& plan);

// No hit yet for each of the first `ray_count` rays.
void append_misses(Chain& chain, const RaySlots& slots, std::uint32_t ray_count);

// The closest hits of the first `ray_count` rays, improved in place. Of the options the size of the picture,
// the samples and the light do not matter. Throws std::invalid_argument for a wide tree with another test,
// and for a filter with brute force.
void append_closest_hits(Chain& chain, const TreeSlots& tree, const RaySlots& slots, std::uint32_t ray_count,
                         const TraceOptions& options);

// Rays next to each other in their slots, whose closest hits are looked for together.
struct RayRange {
  std::uint32_t first = 0, count = 0;
  std::uint32_t next_triangle = 0;  // of brute force: those before have been tested
};

// As much of the same, for the rays of a range, as `work` allows, though at least one step. Returns the work
// of what was appended: in rays, by brute force in tests of triangles. Ranges that begin and end at multiples
// of RANGE_RAYS (the last rays excepted) give the same hits and counters as all rays at once. Throws
// std::invalid_argument for a filter with brute force, and for a range that does not begin at 0 with a count
// on the device.
std::uint64_t append_closest_hits(Chain& chain, const TreeSlots& tree, const RaySlots& slots, RayRange& range,
                                  const TraceOptions& options, std::uint64_t work);
bool has_closest_hits(const TreeSlots& tree, const RayRange& range, const TraceOptions& options);

inline constexpr std::uint32_t RANGE_RAYS = TRACE_BLOCK;
static_assert(RANGE_RAYS % TRACE_PACKET == 0 && RANGE_RAYS % TRACE_GROUP == 0);

// From the hits of the first `ray_count` rays one ray each, random by `seed`, with no hit yet.
void append_bounce(Chain& chain, const TreeSlots& tree, const RaySlots& slots, const RaySlots& bounced,
                   std::uint32_t ray_count, std::uint32_t seed);

// Pixels of so much radiance.
void append_resolve(Chain& chain, const TracePlan& plan, Vec3Buffer radiance, std::uint32_t first_pixel,
                    std::uint32_t count);

// Pixels of radiance that is kept of the whole picture.
void append_resolved(Chain& chain, const TracePlan& plan);

// Tree to image: camera rays, closest hits, shading, sRGB.
void append_trace(Chain& chain, const TreeSlots& tree, const TracePlan& plan);

// For each 8-bit sRGB code the bits of the least linear value that rounds to it (IEC 61966-2-1); minus
// infinity for 0.
std::array<uint, 256> srgb_thresholds();

}  // namespace coppice
