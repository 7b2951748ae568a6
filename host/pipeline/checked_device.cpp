#include "pipeline/checked_device.h"

#include <stdexcept>
#include <utility>

#include "pipeline/variant_table.h"
#include "pipeline/verdicts.h"

namespace coppice {

namespace {

// A conversion to wide nodes takes as long a triangle as it saves a ray of a picture, at so many triangles a
// ray: docs/performance.md, "Which tree".
constexpr std::uint64_t triangles_a_ray = 4;

Variants choose_variants(const Device& device, const std::string& choice, const Note& note) {
  if (choice == "auto") return variants_of(device, note);
  Variants variants = default_variants(device.properties());
  const std::string error = choice == "default" ? std::string() : set_variants(choice, variants);
  if (!error.empty()) throw std::invalid_argument(error);
  return variants;
}

}  // namespace

TraceOptions within_loop_turns(TraceOptions wanted, const DeviceProperties& device) {
  if (device.loop_turn_limit != 0) {
    // Two visits a turn stretch the turns that the driver's loops may take, for a fifth more time.
    wanted.max_turns = device.max_turns();
    wanted.visits_per_turn = 2;
  }
  return wanted;
}

CheckedDevice::CheckedDevice(const DeviceOptions& options, const DeviceChoices& choices, DeviceUse use,
                             Note note, const Note& waiting)
    : CheckedDevice(Device(options), choices, std::move(use), std::move(note), waiting) {}

CheckedDevice::CheckedDevice(Device device, const DeviceChoices& choices, DeviceUse use, Note note,
                             const Note& waiting)
    : note_(std::move(note)), device_(std::move(device)), walk_(choices.walk) {
  if (properties().loop_turn_limit != 0) {  // one of the old lavapipes
    const std::string& remedy = choices.slow_driver_remedy;
    this->note("lavapipe of " + properties().driver + " is 4 to 15 times slower than that of Mesa 25" +
               (remedy.empty() ? "" : ": " + remedy));
  }
  if (waiting && !device_.has_kept_pipelines())
    waiting("compiling the kernels for " + properties().name + ", as no earlier run has left them");
  variants_ = choose_variants(device_, choices.variants, note_);
  use.build = build_options(use.build);
  for (TraceOptions& trace : use.traces) trace = picture_options(trace, use.triangle_count);
  const bool works = kept_check_device(device_, use);
  lookback_ = choices.lookback == LookbackChoice::automatic ? works : choices.lookback == LookbackChoice::on;
}

BuildOptions CheckedDevice::build_options(BuildOptions wanted) const {
  wanted.lookback = lookback_;
  wanted.variants = variants_;
  return wanted;
}

TraceOptions CheckedDevice::trace_options(TraceOptions wanted) const {
  return within_loop_turns(wanted, properties());
}

TraceOptions CheckedDevice::picture_options(TraceOptions wanted, std::uint32_t triangle_count) const {
  wanted = trace_options(wanted);
  const bool can = can_trace_wide(wanted);
  if (!can && (walk_.any_wide || (walk_.walk && is_wide(*walk_.walk))))
    throw std::invalid_argument(walk_.said +
                                " is traced with the watertight and the robust test, and needs a tree");
  if (wanted.walk == Walk::brute_force) return wanted;
  const std::uint64_t rays = std::uint64_t{wanted.width} * wanted.height * wanted.samples;
  const bool wide =
      walk_.any_wide || (can && variants_.walk() != Walk::binary && rays * triangles_a_ray > triangle_count);
  wanted.walk = walk_.walk ? *walk_.walk : wide ? wide_walk() : Walk::binary;
  return wanted;
}

Walk CheckedDevice::wide_walk() const {
  if (is_wide(variants_.walk())) return variants_.walk();
  return properties().type == DeviceType::cpu ? Walk::wide_packets : Walk::wide_single;
}

void CheckedDevice::note(const std::string& line) const {
  if (note_) note_(line);
}

void CheckedDevice::note_once(const std::string& line) {
  if (said_.insert(line).second) note(line);
}

}  // namespace coppice
