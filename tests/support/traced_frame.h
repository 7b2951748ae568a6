#pragma once

#include <gtest/gtest.h>

#include "render/frame.h"
#include "stages/gpu_executor.h"
#include "support/test_device.h"

namespace coppice {

// Builds and traces a frame that is uploaded, the trace in submits of so much work.
inline void trace_frame_in_pieces(GpuExecutor& executor, const FramePlan& plan, std::uint64_t work) {
  Chain build = executor.chain();
  append_frame_build(build, plan);
  append_frame_wide(build, plan);
  executor.record(build.steps()).submit_and_wait(submit_limit_seconds);
  for (TracePieces pieces = plan.pieces(plan.trace); !pieces.done();) {
    Chain chain = executor.chain();
    pieces.append(chain, work);
    executor.record(chain.steps()).submit_and_wait(submit_limit_seconds);
  }
  EXPECT_EQ(executor.read(plan.tree.state)[0].error_word, 0u);
}

}  // namespace coppice
