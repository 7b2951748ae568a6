#include "twins/tone.h"

namespace coppice::twins {

namespace {

using Weights = float[3];

float weighted(const Weights& weights, const float (&values)[3]) {
  float sum = weights[0] * values[0];
  for (int i = 1; i < 3; ++i) sum += weights[i] * values[i];
  return sum;
}

// Rows of sRGB to the space of the fit, and back.
constexpr Weights into_aces[] = {
    {0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
constexpr Weights out_of_aces[] = {
    {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};

float fit(float v) {
  const float numerator = v * (v + 0.0245786f) - 0.000090537f;
  const float denominator = v * (0.983729f * v + 0.4329510f) + 0.238081f;
  return numerator / denominator;
}

// NaN is 0.
float channel_in_range(float x) {
  if (!(x > 0)) return 0;
  return x < TONE_MOST ? x : TONE_MOST;
}

}  // namespace

vec3 tone_of(const vec3& radiance, uint curve) {
  if (curve == TONE_NONE) return radiance;
  const float channels[] = {channel_in_range(radiance.x), channel_in_range(radiance.y),
                            channel_in_range(radiance.z)};
  if (curve == TONE_REINHARD) {
    const float y = weighted({0.2126f, 0.7152f, 0.0722f}, channels);
    const float ratio = (1 + y / (TONE_WHITE * TONE_WHITE)) / (1 + y);
    return {channels[0] * ratio, channels[1] * ratio, channels[2] * ratio};
  }
  float fitted[3];
  for (int i = 0; i < 3; ++i) fitted[i] = fit(weighted(into_aces[i], channels));
  return {weighted(out_of_aces[0], fitted), weighted(out_of_aces[1], fitted),
          weighted(out_of_aces[2], fitted)};
}

}  // namespace coppice::twins
