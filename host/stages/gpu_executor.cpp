#include "stages/gpu_executor.h"

#include "stages/record_step.h"

namespace coppice {

Recorder GpuExecutor::record(std::span<const Step> steps, Timestamps timestamps) {
  Recorder recorder(device_, arena_, static_cast<std::uint32_t>(steps.size()), timestamps);
  Hazards hazards(AddressMap(layout_, arena_.block_addresses()),
                  timestamps == Timestamps::every_step ? Hazards::Overlap::clears : Hazards::Overlap::steps);
  for (const Step& step : steps) {
    record_step(recorder, step, hazards);
    if (std::holds_alternative<Mark>(step)) recorder.mark();
  }
  return recorder;
}

}  // namespace coppice
