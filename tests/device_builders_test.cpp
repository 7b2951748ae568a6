// The tree of every builder is traced on the device with the hits of the CPU tracer and of brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "builders/registry.h"
#include "render/frame.h"
#include "scene/generators.h"
#include "stages/errors.h"
#include "support/device_run.h"
#include "support/hit_referee.h"
#include "support/rays.h"

namespace coppice {
namespace {

constexpr std::uint32_t TRIANGLE_COUNT = 5000;
constexpr std::uint32_t RAY_COUNT = 20000;

struct TracedScene {
  std::vector<Triangle> triangles;
  std::vector<Ray> rays;
  std::vector<Hit> by_force;  // on the device
};

// Made once a process.
const TracedScene& traced_scene(Scene (*make)()) {
  static std::map<Scene (*)(), TracedScene> scenes;
  TracedScene& scene = scenes[make];
  if (scene.triangles.empty()) {
    scene.triangles = scene_arrays(make()).triangles;
    scene.rays = rays_around(scene.triangles, RAY_COUNT, 1);
    scene.by_force = trace_on_device({}, scene.triangles, scene.rays).hits;
  }
  return scene;
}

Scene small_scatter() { return make_scatter(TRIANGLE_COUNT); }
Scene small_terrain() { return make_terrain(TRIANGLE_COUNT); }

class DeviceTraceOf : public DeviceTest, public testing::WithParamInterface<std::string_view> {
 protected:
  static std::vector<Node> build(const std::vector<Triangle>& triangles) {
    if (const NamedDeviceBuilder* named = find_device_builder(GetParam())) {
      BuildOptions options;
      options.builder = named->builder;
      return build_on(test_device(), triangles, options).nodes;
    }
    return find_cpu_builder(GetParam()).build(triangles, {}).nodes;
  }

  // The CPU tracer computes in double, the device in float.
  static void expect_hits_of_cpu_tracer_but_for_edges(Scene (*make)()) {
    const TracedScene& scene = traced_scene(make);
    const std::vector<Node> nodes = build(scene.triangles);
    const TracedRays device = trace_on_device(nodes, scene.triangles, scene.rays);
    EXPECT_EQ(device.error_word, 0u) << describe_error_word(device.error_word);
    std::vector<Hit> cpu(scene.rays.size());
    trace_all(nodes, scene.triangles, scene.rays, cpu);
    const Verdicts verdicts = judge_all(scene.triangles, scene.rays, cpu, device.hits);
    EXPECT_GT(verdicts.hits, scene.rays.size() / 20);
    EXPECT_EQ(verdicts.wrong, 0u) << "ray " << verdicts.first_wrong;
    EXPECT_LE(verdicts.disputed(), scene.rays.size() / 1000);
  }

  static void expect_hits_of_brute_force(Scene (*make)()) {
    const TracedScene& scene = traced_scene(make);
    const TracedRays device = trace_on_device(build(scene.triangles), scene.triangles, scene.rays);
    EXPECT_EQ(device.error_word, 0u) << describe_error_word(device.error_word);
    const bool splits = !find_device_builder(GetParam()) && find_cpu_builder(GetParam()).splits_triangles;
    // A hit on the seam of two parts may be lost to rounding.
    const std::uint64_t most = splits ? scene.rays.size() / 10'000 : 0;
    EXPECT_LE(compare_hits(device.hits, scene.by_force).other_triangle, most);
  }
};

// "none" is brute force itself.
class DeviceTraceOfTree : public DeviceTraceOf {};

TEST_P(DeviceTraceOf, ScatterAgreesWithTheCpuTracerButForEdges) {
  expect_hits_of_cpu_tracer_but_for_edges(small_scatter);
}

TEST_P(DeviceTraceOf, TerrainAgreesWithTheCpuTracerButForEdges) {
  expect_hits_of_cpu_tracer_but_for_edges(small_terrain);
}

TEST_P(DeviceTraceOfTree, ScatterAgreesWithBruteForce) { expect_hits_of_brute_force(small_scatter); }

TEST_P(DeviceTraceOfTree, TerrainAgreesWithBruteForce) { expect_hits_of_brute_force(small_terrain); }

std::vector<std::string_view> tree_builders() {
  std::vector<std::string_view> names;
  for (const NamedDeviceBuilder& named : device_builders()) names.push_back(named.name);
  for (const CpuBuilder& builder : cpu_builders()) {
    if (builder.name != "none") names.push_back(builder.name);
  }
  return names;
}

std::string name_of(const testing::TestParamInfo<std::string_view>& info) {
  std::string name(info.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(BruteForce, DeviceTraceOf, testing::Values("none"), name_of);
INSTANTIATE_TEST_SUITE_P(Builders, DeviceTraceOf, testing::ValuesIn(tree_builders()), name_of);
INSTANTIATE_TEST_SUITE_P(Builders, DeviceTraceOfTree, testing::ValuesIn(tree_builders()), name_of);

}  // namespace
}  // namespace coppice
