#pragma once

#include "gpu/command_writer.h"
#include "stages/hazards.h"

namespace coppice {

inline Kernel kernel_of(const Dispatch& dispatch) {
  return {dispatch.stage->name, dispatch.stage->kernel, dispatch.constants.span()};
}

// To a Recorder or a CommandWriter, behind a barrier where there must be one. A mark, which is no command,
// records nothing.
template <class Target>
void record_step(Target& target, const Step& step, Hazards& hazards) {
  if (hazards.needs_barrier(step)) target.barrier();
  if (const Clear* const clear = std::get_if<Clear>(&step)) {
    target.clear(clear->place.block, clear->place.offset, clear->bytes);
  } else if (const Dispatch* const dispatch = dispatch_of(step)) {
    const auto args = std::span(dispatch->args).first(dispatch->args_bytes);
    if (dispatch->indirect) {
      target.dispatch_indirect(kernel_of(*dispatch), args, dispatch->indirect->block,
                               dispatch->indirect->offset);
    } else {
      target.dispatch(kernel_of(*dispatch), args,
                      {dispatch->groups.x, dispatch->groups.y, dispatch->groups.z});
    }
  }
}

}  // namespace coppice
