#pragma once

#include <cstdint>
#include <functional>

#include "pipeline/trace_plan.h"

namespace coppice {

// What ends a picture that is refined pass by pass, each of some samples of every pixel: the first that is
// reached, after one pass at least.
struct RefineLimits {
  double seconds = 0;                  // of tracing; 0: any number
  double error = 0;                    // as picture_error has it; 0: whatever it is
  std::uint32_t most_samples = 65536;  // a pixel

  bool adaptive = false;  // after 16 samples only of pixels whose own error is larger than `error`

  bool any() const { return seconds > 0 || error > 0; }
};

enum class RefineEnd { seconds, error, samples };

// How far a picture came.
struct Refined {
  std::uint32_t samples = 0;  // a pixel; of an adaptive one the most
  double seconds = 0;         // of tracing, host clock around submit and wait
  double error = 0;           // estimated; infinite of one sample
  RefineEnd ended_by = RefineEnd::samples;
};

// As --json has it.
const char* name_of(RefineEnd end);

// Fewer samples say too little of the error to be believed.
inline constexpr std::uint32_t REFINE_LEAST_SAMPLES = 16;

// Samples of the next pass, 0 where none is needed: `so_far` then says what ended it. With an error to reach
// as many as its fall by the root of their number lets expect, at most as many as there are; within the time
// that is left.
std::uint32_t samples_of_next_pass(const RefineLimits& limits, Refined& so_far);

// Passes until there are enough. `pass` takes the samples from the first number up to the second one, and
// returns the seconds it took; `error` estimates that of so many samples, at least 2.
Refined refine(const RefineLimits& limits, const std::function<double(std::uint32_t, std::uint32_t)>& pass,
               const std::function<double(std::uint32_t)>& error);

// Whether a pass that begins with this sample takes it of some pixels only.
inline bool is_of_some_pixels(const RefineLimits& limits, std::uint32_t first_sample) {
  return limits.adaptive && first_sample >= REFINE_LEAST_SAMPLES;
}

// The trace of the samples of one pass, whose pixels are not made yet.
TracePlan plan_of_pass(const TracePlan& plan, std::uint32_t first_sample, std::uint32_t end_sample);

}  // namespace coppice
