#include "apps/checked_device.h"

#include <unistd.h>

#include <cstdio>

#include "apps/driver_note.h"
#include "pipeline/self_check.h"
#include "pipeline/variant_table.h"
#include "scene/input_error.h"

namespace coppice {

BuildOptions CheckedDevice::build_options(const Options& options, std::uint32_t morton_bits) const {
  BuildOptions build;
  build.radius = options.radius;
  build.morton_bits = morton_bits;
  build.lookback = lookback;
  build.variants = variants;
  if (const NamedDeviceBuilder* named = find_device_builder(options.builder)) build.builder = named->builder;
  return build;
}

TraceOptions CheckedDevice::trace_options(const Options& options) const {
  TraceOptions trace;
  trace.width = options.width;
  trace.height = options.height;
  trace.samples = options.samples;
  trace.brute_force = options.builder == "none";
  trace.triangle_test = options.triangle_test == "fast" ? TRIANGLE_FAST : TRIANGLE_WATERTIGHT;
  trace.box_test = options.box_test == "fast" ? BOX_FAST : BOX_ROBUST;
  trace.packets = packets(options);
  if (const std::uint32_t limit = device.properties().loop_turn_limit) {
    // Two visits a turn stretch the turns that the driver's loops may take, for a fifth more time.
    trace.max_turns = limit - 1000;
    trace.visits_per_turn = 2;
  }
  return trace;
}

bool CheckedDevice::packets(const Options& options) const {
  if (options.tree == "wide-packets" || options.tree == "wide-single") return options.tree == "wide-packets";
  if (variants.trace != TRACE_BINARY) return variants.trace == TRACE_WIDE_PACKETS;
  return device.properties().type == DeviceType::cpu;
}

bool CheckedDevice::walks_wide(const Options& options, std::uint32_t triangle_count) const {
  const bool can = can_trace_wide(trace_options(options));
  if (options.tree != "auto") {
    const bool wide = options.tree != "binary";
    if (wide && !can)
      throw InputError("--tree " + options.tree +
                       " is traced with the watertight and the robust test, and needs a tree");
    return wide;
  }
  const std::uint64_t rays = std::uint64_t{options.width} * options.height * options.samples;
  return can && variants.trace != TRACE_BINARY && rays > triangle_count;
}

CheckedDevice open_device(const Options& options, const CommandUse& command) {
  CheckedDevice checked{Device({options.device, options.validate, false, cache_folder()}), true, {}};
  note_slow_driver(checked.device.properties());
  if (!checked.device.has_kept_pipelines() && isatty(STDERR_FILENO)) {
    std::fprintf(stderr, "note: compiling the kernels for %s, as no earlier run has left them\n",
                 checked.device.properties().name.c_str());
  }
  checked.variants = options.variants == "auto" ? variants_of(checked.device)
                                                : default_variants(checked.device.properties());
  if (options.variants != "auto" && options.variants != "default")
    set_variants(options.variants, checked.variants);
  DeviceUse use{command.builds, checked.build_options(options, options.morton_bits == "60" ? 60 : 30), {}};
  if (command.traces) {
    TraceOptions trace = checked.trace_options(options);
    trace.wide = checked.walks_wide(options, command.triangle_count);
    use.traces.push_back(trace);
  }
  const bool works = check_device(checked.device, use);
  checked.lookback = options.lookback == "auto" ? works : options.lookback == "on";
  return checked;
}

int validation_status(Device& device) {
  const auto messages = device.take_validation_messages();
  for (const std::string& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
  return messages.empty() ? 0 : 1;
}

}  // namespace coppice
