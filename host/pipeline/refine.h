#pragma once

#include "interface/refine.h"
#include "stages/chain.h"

namespace coppice {

// What a picture that is refined by and by keeps beside its radiance, so that its error is known: empty where
// none is.
struct NoiseSlots {
  Slot<vec3> sample_radiance;     // of one sample of each ray of a band
  Slot<LuminanceSums> luminance;  // one a pixel, in the order of FILM_STRIP
  Slot<float> sums;               // of runs of pixels, then of runs of these, and so on to a single one
};

NoiseSlots plan_noise(Layout& layout, std::uint32_t band_rays, std::uint32_t pixel_count);

// Adds the sample of so many pixels, the first of which is `first_pixel`, to `radiance`, which is theirs.
void append_sample(Chain& chain, const NoiseSlots& slots, std::uint32_t first_ray, std::uint32_t first_pixel,
                   std::uint32_t count, Vec3Buffer radiance, std::uint32_t sample_index);

// Sums over all pixels what picture_error takes. `samples`: that all of them have, at least 2.
void append_noise_sum(Chain& chain, const NoiseSlots& slots, std::uint32_t samples);

// Where that sum is.
Slot<float> noise_sum_of(const NoiseSlots& slots);

// The root of the mean over all pixels of the squared relative errors of their means, estimated from their
// own samples: (variance of the samples / their number) / (mean^2 + NOISE_DARK), of luminance.
double picture_error(float noise_sum, std::uint64_t pixel_count);

}  // namespace coppice
