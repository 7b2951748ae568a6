// Times every CPU builder on scatter scenes. Not a test: run by hand, on an idle machine.
#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "analysis/quality.h"
#include "builders/registry.h"
#include "scene/generators.h"
#include "support/triangles.h"

namespace coppice {
namespace {

const std::vector<Triangle>& scatter_of(std::int64_t triangle_count) {
  static std::map<std::int64_t, std::vector<Triangle>> scenes;
  std::vector<Triangle>& triangles = scenes[triangle_count];
  if (triangles.empty()) triangles = triangles_of(make_scatter(static_cast<std::uint32_t>(triangle_count)));
  return triangles;
}

// state.range(0): triangles.
void time_builder(benchmark::State& state, const CpuBuilder* builder) {
  const std::vector<Triangle>& triangles = scatter_of(state.range(0));
  Bvh bvh;
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    bvh = {};
    state.ResumeTiming();
    bvh = builder->build(triangles, {});
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["sah"] = measure_quality(bvh.nodes).sah;
}

void register_builders() {
  for (const CpuBuilder& builder : cpu_builders()) {
    if (builder.name == "none") continue;  // it builds nothing
    const std::string name = std::string(builder.name) + "/scatter";
    benchmark::RegisterBenchmark(name.c_str(), time_builder, &builder)
        ->Arg(10'000)
        ->Arg(100'000)
        ->Arg(1'000'000)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace coppice

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  coppice::register_builders();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
