// Tone curves are what their papers say, at what is known of them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/trace_plan.h"
#include "twins/tone.h"

namespace coppice {
namespace {

float grey_by(float x, uint curve) { return twins::tone_of(vec3(x), curve).y; }

float luminance_by_weights(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

TEST(ToneMapping, NoneLeavesEveryBit) {
  const vec3 colour = twins::tone_of({-1, 3e38f, 0.1f}, TONE_NONE);
  EXPECT_EQ(colour, vec3(-1, 3e38f, 0.1f));
}

// Equation 4: L (1 + L / white^2) / (1 + L).
TEST(ToneMapping, ReinhardMakesItsWhiteOneAndKeepsTheRatiosOfChannels) {
  EXPECT_NEAR(grey_by(TONE_WHITE, TONE_REINHARD), 1, 1e-6);
  EXPECT_NEAR(grey_by(1, TONE_REINHARD), (1 + 1 / 16.0) / 2, 1e-6);
  EXPECT_NEAR(grey_by(0.18f, TONE_REINHARD), 0.18 * (1 + 0.18 / 16) / 1.18, 1e-6);
  EXPECT_EQ(grey_by(0, TONE_REINHARD), 0);
  const vec3 colour{3, 0.5f, 0.125f}, mapped = twins::tone_of(colour, TONE_REINHARD);
  EXPECT_NEAR(mapped.x / mapped.y, 6, 1e-5);
  EXPECT_NEAR(mapped.y / mapped.z, 4, 1e-5);
  const float y = luminance_by_weights(colour);
  EXPECT_NEAR(luminance_by_weights(mapped), y * (1 + y / 16) / (1 + y), 1e-5);
}

// The values of Hill's fit in double, and that grey stays grey.
TEST(ToneMapping, AcesHasTheValuesOfItsFit) {
  for (const double x : {0.0, 0.01, 0.18, 0.5, 1.0, 4.0, 16.0, 1000.0}) {
    const double expected = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    const vec3 mapped = twins::tone_of(vec3(static_cast<float>(x)), TONE_ACES);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(mapped[i], expected, 5e-5 * std::max(1.0, expected)) << x;
  }
  // What is bright turns white, whatever its colour.
  const vec3 red = twins::tone_of({100, 0, 0}, TONE_ACES);
  EXPECT_GT(red.x, 1);
  EXPECT_GT(red.y, 0.1f);
}

TEST(ToneMapping, CurvesRiseFromBlackAndTakeAnything) {
  for (const uint curve : {TONE_REINHARD, TONE_ACES}) {
    float before = grey_by(0, curve);
    EXPECT_LE(before, 0);
    for (int i = -40; i <= 64; ++i) {
      const float x = std::exp2(static_cast<float>(i) / 4), now = grey_by(x, curve);
      EXPECT_GT(now, before) << TONE_CURVE_NAMES[curve] << " of " << x;
      before = now;
    }
    constexpr float inf = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(std::isfinite(grey_by(inf, curve)));
    EXPECT_EQ(grey_by(std::nanf(""), curve), grey_by(0, curve));
    EXPECT_EQ(grey_by(-inf, curve), grey_by(0, curve));
  }
}

TEST(ToneMapping, ExposureIsAPowerOfTwo) {
  EXPECT_EQ((ToneMapping{TONE_NONE, 3}.exposure()), 8);
  EXPECT_EQ((ToneMapping{TONE_NONE, -2}.exposure()), 0.25f);
  EXPECT_NEAR((ToneMapping{TONE_NONE, 0.5}.exposure()), 1.41421356, 1e-6);
  EXPECT_FALSE(ToneMapping{}.changes());
  EXPECT_TRUE((ToneMapping{TONE_ACES, 0}.changes()));
  EXPECT_TRUE((ToneMapping{TONE_NONE, 1}.changes()));
}

// What does not ask for them is recorded as if there were none.
TEST(ToneMapping, OnlyAPictureThatIsMappedKeepsRadiance) {
  TraceOptions options;
  options.walk = Walk::wide_packets;
  EXPECT_TRUE(traces_pixels(options));
  options.tone.curve = TONE_REINHARD;
  EXPECT_TRUE(keeps_radiance(options));
  EXPECT_FALSE(traces_pixels(options));
}

}  // namespace
}  // namespace coppice
