#pragma once

#include "interface/refine.h"
#include "pipeline/scan_plan.h"
#include "stages/chain.h"

namespace coppice {

// What a picture that is refined by and by keeps beside its radiance, so that its error is known: empty where
// none is.
struct NoiseSlots {
  Slot<vec3> sample_radiance;     // of one sample of each ray of a band
  Slot<LuminanceSums> luminance;  // one a pixel, in the order of FILM_STRIP
  Slot<float> sums;               // of runs of pixels, then of runs of these, and so on to a single one

  // Of a picture that takes more samples of some pixels than of others: empty where it does not.
  Slot<uint> sample_counts;   // one a pixel
  Slot<uvec4> marks, places;  // words, one a pixel
  Slot<uint> scan_status;
  Slot<uint> pixels;        // that have more error than asked for, by their places
  Slot<uint> active_count;  // how many
};

NoiseSlots plan_noise(Layout& layout, std::uint32_t band_rays, std::uint32_t pixel_count, bool adaptive);

// A sample of so many pixels, whose radiance is in the first entries of `sample_radiance` from `first_ray`
// on.
struct AddedSample {
  std::uint32_t first_ray, count, sample_index;
  std::uint32_t first_pixel;  // of those of which it is a sample
  Slot<uint> pixels;          // or, where there is a slot, those that it names from `first_pixel` on
};

// Adds it to `radiance`, that of the whole picture, and to what is kept beside it.
void append_sample(Chain& chain, const NoiseSlots& slots, Slot<vec3> radiance, const AddedSample& sample);

// Lists the pixels whose relative error is larger than `error`. All have two samples at least.
void append_active_pixels(Chain& chain, const NoiseSlots& slots, Slot<BuildState> state, double error);

// Sums over all pixels what picture_error takes. `samples`: that all of them have, at least 2.
void append_noise_sum(Chain& chain, const NoiseSlots& slots, std::uint32_t samples);

// Where that sum is.
Slot<float> noise_sum_of(const NoiseSlots& slots);

// The root of the mean over all pixels of the squared relative errors of their means, estimated from their
// own samples: (variance of the samples / their number) / (mean^2 + NOISE_DARK), of luminance.
double picture_error(float noise_sum, std::uint64_t pixel_count);

}  // namespace coppice
