#include "pipeline/refine.h"

#include <cmath>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

std::uint32_t runs_of(std::uint32_t count) { return divide_up(count, NOISE_SUM_RUN); }

}  // namespace

NoiseSlots plan_noise(Layout& layout, std::uint32_t band_rays, std::uint32_t pixel_count) {
  std::uint64_t sums = 0;
  for (std::uint32_t count = runs_of(pixel_count);; count = runs_of(count)) {
    sums += count;
    if (count <= 1) break;
  }
  return {layout.add<vec3>("sample_radiance", band_rays), layout.add<LuminanceSums>("luminance", pixel_count),
          layout.add<float>("noise_sums", sums)};
}

void append_sample(Chain& chain, const NoiseSlots& slots, std::uint32_t first_ray, std::uint32_t first_pixel,
                   std::uint32_t count, Vec3Buffer radiance, std::uint32_t sample_index) {
  chain.run(stages::sample_add,
            {chain.at(slots.sample_radiance, first_ray), radiance, chain.at(slots.luminance, first_pixel),
             count, sample_index},
            groups_of(count, SAMPLE_ADD_GROUP));
}

void append_noise_sum(Chain& chain, const NoiseSlots& slots, std::uint32_t samples) {
  LuminanceSumsBuffer luminance = chain.at(slots.luminance);
  FloatBuffer values{};
  std::uint64_t first_sum = 0;
  for (auto count = static_cast<std::uint32_t>(slots.luminance.count);;) {
    const std::uint32_t runs = runs_of(count);
    const FloatBuffer sums = chain.at(slots.sums, first_sum);
    chain.run(stages::noise_sum, {luminance, values, sums, count, samples}, groups_of(runs, NOISE_SUM_GROUP),
              {luminance.value != 0});
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
