#pragma once

#include <utility>
#include <vector>

#include "pipeline/interruption.h"
#include "pipeline/pace.h"
#include "stages/gpu_executor.h"

namespace coppice {

// No submit may take longer: the program ends then, with one line.
inline constexpr double piece_limit_seconds = 600;

// What one submit of a piece did.
struct SubmittedPiece {
  std::vector<Step> steps;
  Recorder::Times times;
  std::uint64_t work;
};

// Submits the next piece (of HitPieces or TracePieces), as large as `pace` says, which learns from it.
template <class Pieces>
SubmittedPiece submit_piece(GpuExecutor& executor, Pieces& pieces, Pace& pace, Timestamps timestamps) {
  Chain chain = executor.chain();
  const std::uint64_t work = pieces.append(chain, pace.work());
  const Recorder::Times times =
      executor.record(chain.steps(), timestamps).submit_and_wait(piece_limit_seconds);
  pace.note(work, times.wall_ms);
  return {std::move(chain.steps()), times, work};
}

// Submits all pieces and calls `after` with each SubmittedPiece. Between two a signal that was noted ends it
// by Interrupted; nothing is under way then.
template <class Pieces, class After>
void submit_pieces(GpuExecutor& executor, Pieces pieces, Pace& pace, Timestamps timestamps, After after) {
  const InterruptionGuard guard;
  while (!pieces.done()) {
    throw_if_interrupted();
    after(submit_piece(executor, pieces, pace, timestamps));
  }
  throw_if_interrupted();
}

}  // namespace coppice
