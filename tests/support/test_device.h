#pragma once

#include <gtest/gtest.h>

#include "gpu/device.h"
#include "pipeline/build_plan.h"
#include "pipeline/trace_plan.h"
#include "scene/scene.h"

namespace coppice {

// The device of all tests of this process, under the validation layers, synchronization validation on.
Device& test_device();

// Nothing in a test waits longer.
inline constexpr double submit_limit_seconds = 120;

// Fails after every test to which the validation layers had something to say.
class DeviceTest : public testing::Test {
 protected:
  void TearDown() override;
};

// What traces on the test device must be planned with.
TraceOptions test_trace_options(std::uint32_t width, std::uint32_t height);

// `count` deterministic random triangles in the unit cube; `size` is their extent.
std::vector<Triangle> random_triangles(std::uint32_t count, std::uint32_t seed, float size = 0.02f);

}  // namespace coppice
