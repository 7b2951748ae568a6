#include "coppice/context.h"

#include "library/state.h"
#include "pipeline/variant_table.h"
#include "pipeline/verdicts.h"

namespace coppice {

namespace {

Variants variants_for(const Device& device) {
  return variants_of(device, [&](const std::string& line) { device.say(line); });
}

}  // namespace

Context::State::State(const ContextOptions& options)
    : device_({.select = options.select,
               .validate = options.validate,
               .pipeline_folder = options.cache_folder,
               .log = options.log}),
      variants_(variants_for(device_)) {}

Context::State::State(const AdoptedDevice& device, const ContextOptions& options)
    : device_(device, options.cache_folder, options.log), variants_(variants_for(device_)) {}

bool Context::State::check(const DeviceUse& use) {
  const std::lock_guard lock(check_mutex_);
  if (device_.queue()) {
    const auto [verdict, is_new] = verdicts_.try_emplace(line_of(use), false);
    if (!is_new) return verdict->second;
    try {
      return verdict->second = kept_check_device(device_, use);
    } catch (...) {
      verdicts_.erase(verdict);
      throw;
    }
  }
  device_.say("no queue was given: nothing is checked, and no prefix sums are made by lookback");
  return false;
}

BuildOptions Context::State::checked(DeviceUse use) {
  use.build.variants = variants_;
  use.build.lookback = true;
  use.build.lookback = check(use);
  return use.build;
}

TraceOptions Context::State::checked(TraceOptions wanted) {
  wanted = within_loop_turns(wanted, device_.properties());
  DeviceUse use{.builds = false, .traces = {wanted}, .every_ray = true};
  use.build.variants = variants_;
  check(use);
  return wanted;
}

Context::Context(const ContextOptions& options) : state_(std::make_unique<State>(options)) {}
Context::Context(const AdoptedDevice& device, const ContextOptions& options)
    : state_(std::make_unique<State>(device, options)) {}
Context::~Context() = default;
Context::Context(Context&&) noexcept = default;

Capabilities Context::capabilities() const {
  const DeviceProperties& device = state_->device().properties();
  return {device.name,
          device.driver,
          device.subgroup_size,
          device.timestamp_period_ns,
          device.loop_turn_limit,
          to_string(state_->variants())};
}

VkInstance Context::instance() const { return state_->device().instance(); }
VkPhysicalDevice Context::physical_device() const { return state_->device().physical_device(); }
VkDevice Context::device() const { return state_->device().device(); }
VkQueue Context::queue() const { return state_->device().queue(); }
std::uint32_t Context::queue_family() const { return state_->device().queue_family(); }
std::vector<std::string> Context::take_validation_messages() {
  return state_->device().take_validation_messages();
}

}  // namespace coppice
