#include "apps/option_rules.h"

#include <algorithm>

#include "pipeline/build.h"

namespace coppice {

namespace {

bool is_given(const CLI::App& command, std::string_view option) {
  const CLI::Option* const found = command.get_option_no_throw(std::string(option));
  return found && found->count() > 0;
}

bool builds_on_device(const Options& options) { return find_device_builder(options.builder) != nullptr; }

bool traces_on_device(const Options& options) { return options.tracer == "gpu"; }

bool uses_device(const Options& options) { return builds_on_device(options) || traces_on_device(options); }

bool has_rounds(const Options& options) {
  const NamedDeviceBuilder* const named = find_device_builder(options.builder);
  return named && named->builder == DeviceBuilder::ploc;
}

bool compares_device_builder(const Options& options) {
  return options.builders.empty() || std::ranges::any_of(options.builders, [](const auto& name) {
           return find_device_builder(name) != nullptr;
         });
}

// What `bench` measures.
bool traces(const Options& options) { return options.bench == "trace"; }
bool has_sizes(const Options& options) { return !traces(options); }
bool has_builders(const Options& options) { return options.bench == "build" || traces(options); }
bool has_trees(const Options& options) { return options.bench == "ploc" || has_builders(options); }
bool has_variants(const Options& options) { return options.bench == "sort" || has_trees(options); }

struct Rule {
  std::string_view command, option;
  bool (*matters)(const Options&);
  const char* needs;
};

constexpr const char* a_device = "that something runs on the device: --tracer gpu or a builder gpu-...";
constexpr const char* a_device_builder = "a builder on the device, gpu-...";
constexpr const char* a_device_tracer = "--tracer gpu";
constexpr Rule rules[] = {
    {"render", "--trace-events", uses_device, a_device},
    {"render", "--validate", uses_device, a_device},
    {"render", "--variants", uses_device, a_device},
    {"render", "--lookback", builds_on_device, a_device_builder},
    {"render", "--kernels", traces_on_device, a_device_tracer},
    {"render", "--tree", traces_on_device, a_device_tracer},
    {"render", "--triangle-test", traces_on_device, a_device_tracer},
    {"render", "--box-test", traces_on_device, a_device_tracer},
    {"build", "--trace-events", builds_on_device, a_device_builder},
    {"build", "--validate", builds_on_device, a_device_builder},
    {"build", "--variants", builds_on_device, a_device_builder},
    {"build", "--lookback", builds_on_device, a_device_builder},
    {"build", "--wide", builds_on_device, a_device_builder},
    {"build", "--rounds", has_rounds, "a builder with rounds on the device, gpu-ploc"},
    {"compare", "--lookback", compares_device_builder, a_device_builder},
    {"compare", "--variants", compares_device_builder, a_device_builder},
    {"bench", "SCENE", traces, "bench trace"},
    {"bench", "--size", traces, "bench trace"},
    {"bench", "--camera", traces, "bench trace"},
    {"bench", "--up", traces, "bench trace"},
    {"bench", "--builder", has_builders, "bench build or trace"},
    {"bench", "--radius", has_trees, "bench ploc, build or trace"},
    {"bench", "--morton-bits", has_trees, "bench ploc, build or trace"},
    {"bench", "--variants", has_variants, "bench sort, ploc, build or trace"},
    {"bench", "--most", has_sizes, "bench sort, scan, ploc or build"},
};

}  // namespace

void check_options_matter(const CLI::App& command, const Options& options) {
  for (const Rule& rule : rules) {
    if (rule.command == command.get_name() && is_given(command, rule.option) && !rule.matters(options)) {
      throw CLI::ValidationError(std::string(rule.option) + " does nothing here: it needs " + rule.needs);
    }
  }
}

}  // namespace coppice
