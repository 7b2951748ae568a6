#include "stages/gpu_executor.h"

namespace coppice {

Recorder GpuExecutor::record(std::span<const Step> steps, Timestamps timestamps) {
  Recorder recorder(device_, arena_, static_cast<std::uint32_t>(steps.size()), timestamps);
  for (const Step& step : steps) {
    if (!step.stage && step.clear_bytes == 0) {
      recorder.mark();
    } else if (!step.stage) {
      recorder.clear(step.place.block, step.place.offset, step.clear_bytes);
    } else {
      const Kernel kernel{step.stage->name, step.stage->kernel, step.specialization};
      const auto args = std::span(step.args).first(step.args_bytes);
      if (step.indirect) {
        recorder.dispatch_indirect(kernel, args, step.place.block, step.place.offset);
      } else {
        recorder.dispatch(kernel, args, {step.groups.x, step.groups.y, step.groups.z});
      }
    }
  }
  return recorder;
}

}  // namespace coppice
