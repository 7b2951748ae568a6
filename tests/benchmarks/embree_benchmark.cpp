// Embree on the rays of `coppice bench trace`: through each pixel, and one diffuse bounce from each hit.
// Not a test: run by hand, on an idle machine.
//   embree_benchmarks SCENE [EYE TARGET [FOV]], as three numbers, three and one
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "builders/registry.h"
#include "pipeline/ray_tracing.h"
#include "render/frame.h"
#include "scene/scene_source.h"
#include "support/embree_scene.h"

namespace coppice {
namespace {

struct BenchmarkRays {
  std::vector<Ray> primary, diffuse;
};

BenchmarkRays rays_of(const Scene& scene, std::span<const Triangle> triangles,
                      std::span<const double> camera) {
  BenchmarkRays rays{rays_through(make_film(scene, camera, 1024, 768, 1)), {}};
  const Bvh bvh = find_cpu_builder("ploc").build(triangles, {});
  Device device;
  RayTracing tracing(device, bvh.nodes, triangles, static_cast<std::uint32_t>(rays.primary.size()));
  rays.diffuse = tracing.bounce(rays.primary, {}, 1);
  std::erase_if(rays.diffuse,
                [](const Ray& ray) { return ray.direction == vec3(0); });  // of rays that hit nothing
  return rays;
}

void trace(benchmark::State& state, const EmbreeScene& scene, const std::vector<Ray>& rays) {
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    arena.execute([&] { benchmark::DoNotOptimize(scene.trace(rays).data()); });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}

void run(const std::string& name, const std::vector<double>& camera) {
  const Scene scene = open_scene(name);
  const SceneArrays arrays = scene_arrays(scene);
  const BenchmarkRays rays = rays_of(scene, arrays.triangles, camera);
  const EmbreeScene embree(arrays.triangles);
  for (const auto& [kind, its] : {std::pair("primary", &rays.primary), std::pair("diffuse", &rays.diffuse)}) {
    benchmark::RegisterBenchmark(kind, [&embree, its = its](auto& state) { trace(state, embree, *its); })
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
}

}  // namespace
}  // namespace coppice

int main(int argc, char** argv) try {
  benchmark::Initialize(&argc, argv);
  std::vector<double> camera;
  for (int i = 2; i < argc; ++i) camera.push_back(std::strtod(argv[i], nullptr));
  if (argc < 2 || (argc != 2 && argc != 8 && argc != 9)) {
    std::fprintf(stderr, "usage: embree_benchmarks SCENE [EYE TARGET [FOV]]\n");
    return 2;
  }
  coppice::run(argv[1], camera);
  benchmark::Shutdown();
} catch (const std::exception& error) {
  std::fprintf(stderr, "embree_benchmarks: %s\n", error.what());
  return 1;
}
