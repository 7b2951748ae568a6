#pragma once

#include <csignal>
#include <stdexcept>

namespace coppice {

// A signal asked for an early end; thrown between two pieces of work, so that destructors free and remove
// what there is.
struct Interrupted : std::runtime_error {
  explicit Interrupted(int signal) : std::runtime_error("interrupted"), signal(signal) {}
  int signal;
};

// While one lives, the first SIGINT or SIGTERM is only noted, for throw_if_interrupted; a second one ends the
// program at once. Signals that were ignored stay ignored. They may nest; the outermost counts. A signal that
// nothing asked for by the end of its life takes its former course.
class InterruptionGuard {
 public:
  InterruptionGuard();
  ~InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;

 private:
  bool outermost_;
  struct sigaction interrupt_ {
  }, terminate_{};
};

// Throws Interrupted if a guard noted a signal.
void throw_if_interrupted();

}  // namespace coppice
