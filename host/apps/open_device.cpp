#include "apps/open_device.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

namespace coppice {

namespace {

// ./run.sh unpacks a newer lavapipe beside the program. It takes libraries of its own, so it must be named
// before the program starts.
std::string remedy_of_slow_driver() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path newer = program.parent_path() / "lavapipe";
  if (!std::filesystem::exists(newer / "lvp_icd.json", error))
    return "./run.sh fetches a newer one and runs on it";
  return "run it by ./run.sh, or with VK_DRIVER_FILES=" + (newer / "lvp_icd.json").string() +
         " LD_LIBRARY_PATH=" + (newer / "lib").string();
}

WalkChoice walk_choice_of(const std::string& tree) {
  WalkChoice choice;
  choice.said = "--tree " + tree;
  choice.any_wide = tree == "wide";
  if (tree == "binary") choice.walk = Walk::binary;
  if (tree == "wide-packets") choice.walk = Walk::wide_packets;
  if (tree == "wide-single") choice.walk = Walk::wide_single;
  return choice;
}

LookbackChoice lookback_choice_of(const std::string& lookback) {
  if (lookback == "auto") return LookbackChoice::automatic;
  return lookback == "on" ? LookbackChoice::on : LookbackChoice::off;
}

void print_note(const std::string& line) { std::fprintf(stderr, "note: %s\n", line.c_str()); }

}  // namespace

BuildOptions build_options_of(const Options& options, std::uint32_t morton_bits) {
  BuildOptions build;
  build.radius = options.radius;
  build.morton_bits = morton_bits;
  if (const NamedDeviceBuilder* named = find_device_builder(options.builder)) build.builder = named->builder;
  return build;
}

TraceOptions trace_options_of(const Options& options) {
  TraceOptions trace;
  trace.width = options.width;
  trace.height = options.height;
  trace.samples = options.samples;
  if (options.builder == "none") trace.walk = Walk::brute_force;
  trace.triangle_test = options.triangle_test == "fast" ? TRIANGLE_FAST : TRIANGLE_WATERTIGHT;
  trace.box_test = options.box_test == "fast" ? BOX_FAST : BOX_ROBUST;
  return trace;
}

CheckedDevice open_device(const Options& options, const CommandUse& command) {
  DeviceUse use{command.builds,
                build_options_of(options, options.morton_bits == "60" ? 60 : 30),
                {},
                command.triangle_count};
  if (command.traces) use.traces.push_back(trace_options_of(options));
  const DeviceChoices choices{lookback_choice_of(options.lookback), options.variants,
                              walk_choice_of(options.tree), remedy_of_slow_driver()};
  return CheckedDevice({options.device, options.validate, false, cache_folder()}, choices, use, print_note,
                       isatty(STDERR_FILENO) ? print_note : Note());
}

int validation_status(Device& device) {
  const auto messages = device.take_validation_messages();
  for (const std::string& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
  return messages.empty() ? 0 : 1;
}

}  // namespace coppice
