#include "pipeline/refine.h"

#include <bit>
#include <cmath>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

std::uint32_t runs_of(std::uint32_t count) { return divide_up(count, NOISE_SUM_RUN); }

}  // namespace

NoiseSlots plan_noise(Layout& layout, std::uint32_t band_rays, std::uint32_t pixel_count, bool adaptive) {
  std::uint64_t sums = 0;
  for (std::uint32_t count = runs_of(pixel_count);; count = runs_of(count)) {
    sums += count;
    if (count <= 1) break;
  }
  NoiseSlots slots;
  slots.sample_radiance = layout.add<vec3>("sample_radiance", band_rays);
  slots.luminance = layout.add<LuminanceSums>("luminance", pixel_count);
  slots.sums = layout.add<float>("noise_sums", sums);
  if (!adaptive) return slots;
  slots.sample_counts = layout.add<uint>("sample_counts", pixel_count);
  slots.marks = layout.add<uvec4>("noise_marks", scan_quads(pixel_count));
  slots.places = layout.add<uvec4>("noise_places", scan_quads(pixel_count));
  slots.scan_status = layout.add<uint>("noise_scan_status", scan_status_words(pixel_count));
  slots.pixels = layout.add<uint>("noise_pixels", pixel_count);
  slots.active_count = layout.add<uint>("noise_active_count", 1);
  return slots;
}

void append_sample(Chain& chain, const NoiseSlots& slots, Slot<vec3> radiance, const AddedSample& sample) {
  const bool is_list = sample.pixels.count > 0, has_counts = slots.sample_counts.count > 0;
  const std::uint32_t first = is_list ? 0 : sample.first_pixel;
  UintBuffer counts{}, pixels{};
  if (has_counts) counts = chain.at(slots.sample_counts, first);
  if (is_list) pixels = chain.at(sample.pixels, sample.first_pixel);
  chain.run(stages::sample_add,
            {chain.at(slots.sample_radiance, sample.first_ray), chain.at(radiance, first),
             chain.at(slots.luminance, first), counts, pixels, sample.count, sample.sample_index},
            groups_of(sample.count, SAMPLE_ADD_GROUP), {is_list, has_counts});
}

void append_active_pixels(Chain& chain, const NoiseSlots& slots, Slot<BuildState> state, double error) {
  const auto count = static_cast<std::uint32_t>(slots.luminance.count);
  const auto marks = chain.at(ScanPlan::words_of(slots.marks));
  // So much less that the sum over pixels that are left out is not more than asked for by rounding.
  const auto least = static_cast<float>(error * error * 0.999);
  chain.run(
      stages::noise_marks,
      {chain.at(slots.luminance), chain.at(slots.sample_counts), marks, count, std::bit_cast<uint>(least)},
      groups_of(count, NOISE_MARKS_GROUP));
  ScanPlan scan;
  scan.options.lookback = false;  // as for shadow rays
  scan.word_count = count;
  scan.source = slots.marks;
  scan.target = slots.places;
  scan.status = slots.scan_status;
  scan.state = state;
  append_scan(chain, scan);
  chain.run(stages::noise_pixels,
            {marks, chain.at(ScanPlan::words_of(slots.places)), chain.at(slots.pixels),
             chain.at(slots.active_count), count, 0},
            groups_of(count, NOISE_PIXELS_GROUP));
}

void append_noise_sum(Chain& chain, const NoiseSlots& slots, std::uint32_t samples) {
  LuminanceSumsBuffer luminance = chain.at(slots.luminance);
  FloatBuffer values{};
  std::uint64_t first_sum = 0;
  for (auto count = static_cast<std::uint32_t>(slots.luminance.count);;) {
    const std::uint32_t runs = runs_of(count);
    const FloatBuffer sums = chain.at(slots.sums, first_sum);
    const bool has_counts = luminance.value != 0 && slots.sample_counts.count > 0;
    const UintBuffer counts = has_counts ? chain.at(slots.sample_counts) : UintBuffer{};
    chain.run(stages::noise_sum, {luminance, values, counts, sums, count, samples},
              groups_of(runs, NOISE_SUM_GROUP), {luminance.value != 0, has_counts});
    if (runs <= 1) return;
    luminance = {};
    values = sums;
    first_sum += runs;
    count = runs;
  }
}

Slot<float> noise_sum_of(const NoiseSlots& slots) {
  Slot<float> last = slots.sums;
  last.place.offset += (last.count - 1) * sizeof(float);
  last.count = 1;
  return last;
}

double picture_error(float noise_sum, std::uint64_t pixel_count) {
  return std::sqrt(double{noise_sum} / static_cast<double>(pixel_count));
}

}  // namespace coppice
