#include "stages/gpu_executor.h"

namespace coppice {

Recorder GpuExecutor::record(std::span<const Step> steps, Timestamps timestamps) {
  Recorder recorder(device_, arena_, static_cast<std::uint32_t>(steps.size()), timestamps);
  for (const Step& step : steps) {
    if (const Clear* const clear = std::get_if<Clear>(&step)) {
      recorder.clear(clear->place.block, clear->place.offset, clear->bytes);
    } else if (const Dispatch* const dispatch = dispatch_of(step)) {
      const Kernel kernel{dispatch->stage->name, dispatch->stage->kernel, dispatch->constants.span()};
      const auto args = std::span(dispatch->args).first(dispatch->args_bytes);
      if (dispatch->indirect) {
        recorder.dispatch_indirect(kernel, args, dispatch->indirect->block, dispatch->indirect->offset);
      } else {
        recorder.dispatch(kernel, args, {dispatch->groups.x, dispatch->groups.y, dispatch->groups.z});
      }
    } else {
      recorder.mark();
    }
  }
  return recorder;
}

}  // namespace coppice
