// What does not fit a slot, a block, a plan or a device is refused by a named error; and a device without
// timestamps gives the host's times.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "builders/ploc.h"
#include "pipeline/bounded_submits.h"
#include "pipeline/trace_pieces.h"
#include "support/device_run.h"

namespace coppice {
namespace {

class DeviceBounds : public DeviceTest {};

std::vector<Ray> rays_down(std::uint32_t count) {
  return std::vector<Ray>(count, Ray{vec3(0.5f, 0.5f, 5), 0, vec3(0, 0, -1), 1e9f});
}

TEST_F(DeviceBounds, AnUploadBeyondItsSlotIsRefusedByBothExecutors) {
  Layout layout;
  const auto slot = layout.add<uint>("slot", 100);
  const auto behind = layout.add<uint>("behind", 100);
  GpuExecutor gpu(test_device(), layout);
  CpuExecutor cpu(layout);
  const std::vector<uint> ones(101, 1);
  const auto values = std::span<const uint>(ones);
  EXPECT_THROW(gpu.upload(slot, values), LayoutError);
  EXPECT_THROW(cpu.upload(slot, values), LayoutError);
  EXPECT_THROW(gpu.upload(Slot<uint>{}, values.first(1)), LayoutError);
  gpu.upload(slot, values.first(100));
  cpu.upload(slot, values.first(100));
  EXPECT_EQ(gpu.read(behind), std::vector<uint>(100, 0));
  EXPECT_EQ(gpu.read(slot), std::vector<uint>(100, 1));
  EXPECT_EQ(cpu.read(slot), gpu.read(slot));
  try {
    gpu.upload(slot, values);
    ADD_FAILURE();
  } catch (const LayoutError& error) {
    EXPECT_NE(std::string(error.what()).find("101 elements"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("a slot of 100"), std::string::npos) << error.what();
  }
}

TEST_F(DeviceBounds, CopiesBeyondABlockAreRefused) {
  Arena arena(test_device(), {1024});
  std::vector<std::byte> bytes(1025);
  EXPECT_THROW(arena.upload(0, 0, bytes), DeviceError);
  EXPECT_THROW(arena.upload(0, 1024, std::span(bytes).first(1)), DeviceError);
  EXPECT_THROW(arena.upload(0, ~std::uint64_t{0}, std::span(bytes).first(2)), DeviceError);
  EXPECT_THROW(arena.download(0, 1000, std::span(bytes).first(25)), DeviceError);
  arena.upload(0, 1000, std::span(bytes).first(24));
}

TEST_F(DeviceBounds, MoreRaysThanPlannedAreRefused) {
  const std::vector<Triangle> triangles = random_triangles(100, 1, 0.5f);
  RayTracing tracing(test_device(), build_ploc(triangles, {}).nodes, triangles, 64);
  const TraceOptions options = test_trace_options(1, 1);
  const std::vector<Ray> rays = rays_down(65);
  EXPECT_THROW(tracing.on_device(rays, options), LayoutError);
  EXPECT_THROW(tracing.by_twins(rays, options), LayoutError);
  EXPECT_THROW(tracing.bounce(rays, options, 1), LayoutError);
  EXPECT_EQ(tracing.on_device(std::span(rays).first(64), options).hits.size(), 64u);
  EXPECT_EQ(tracing.on_device({}, options).hits.size(), 0u);
}

// More than a submit of the first pieces, so that rays are traced in several.
TEST_F(DeviceBounds, RaysTracedInPiecesHitWhatTheTwinsHit) {
  const std::vector<Triangle> triangles = random_triangles(500, 2, 0.5f);
  std::vector<Ray> rays;
  for (const Triangle& t : random_triangles(20011, 4, 2.0f)) rays.push_back({t.a, 0, t.b - t.a, 1e9f});
  RayTracing tracing(test_device(), build_ploc(triangles, {}).nodes, triangles, 20011);
  TraceOptions options = test_trace_options(1, 1);
  for (const Walk walk : {Walk::binary, Walk::brute_force}) {
    options.walk = walk;
    const TracedRays device = tracing.on_device(rays, options), twins = tracing.by_twins(rays, options);
    EXPECT_EQ(device.hit_count, twins.hit_count);
    EXPECT_GT(device.hit_count, 1000u);
    EXPECT_EQ(tracing.on_device(rays, options).hit_count, twins.hit_count);
  }
}

// Also that what the device works on is not freed: the validation layers would say so.
[[noreturn]] void give_up_a_submit(Device& device) {
  try {
    Layout layout;
    layout.add<uint>("slot", 100);
    GpuExecutor executor(device, layout);
    executor.record({}).submit_and_wait(0);
  } catch (const DeviceHung& hung) {
    std::fprintf(stderr, "%s\n", hung.what());
    std::_Exit(device.take_validation_messages().empty() ? 1 : 2);
  }
  std::_Exit(3);
}

TEST_F(DeviceBounds, ASubmitThatTakesTooLongIsGivenUpWithOneLine) {
  test_device();
  // The child has none of the driver's threads, so that its submit is never done.
  EXPECT_EXIT(give_up_a_submit(test_device()), testing::ExitedWithCode(1),
              "^[^\n]* did not finish within 0 s\n$");
}

TEST(DeviceWithoutTimestamps, TimesAreTheHosts) {
  Device device({.select = "", .timestamps = false});
  EXPECT_EQ(device.properties().timestamp_period_ns, 0);
  const std::vector<Triangle> triangles = random_triangles(1000, 1, 0.5f);
  RayTracing tracing(device, build_ploc(triangles, {}).nodes, triangles, 1000);
  EXPECT_GT(tracing.on_device(rays_down(1000), test_trace_options(1, 1)).ms, 0);
  Layout layout;
  const auto slot = layout.add<uint>("slot", 100);
  GpuExecutor executor(device, layout);
  Chain chain = executor.chain();
  chain.clear(slot);
  chain.mark();
  const Recorder::Times times = executor.record(chain.steps(), Timestamps::every_step).submit_and_wait(60);
  EXPECT_GT(times.total_ms, 0);
  EXPECT_EQ(times.total_ms, times.wall_ms);
  EXPECT_TRUE(times.marks_ms.empty());
  EXPECT_TRUE(times.steps_ms.empty());
}

}  // namespace
}  // namespace coppice
