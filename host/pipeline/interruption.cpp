#include "pipeline/interruption.h"

#include <atomic>

namespace coppice {

namespace {

std::atomic<int> noted_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // what a signal handler may write
int guards = 0;

void note_signal(int signal) { noted_signal = signal; }

struct sigaction replace(int signal) {
  struct sigaction former {};
  sigaction(signal, nullptr, &former);
  if (former.sa_handler == SIG_IGN) return former;
  struct sigaction noting {};
  noting.sa_handler = note_signal;
  noting.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(signal, &noting, nullptr);
  return former;
}

}  // namespace

InterruptionGuard::InterruptionGuard() : outermost_(guards++ == 0) {
  if (!outermost_) return;
  interrupt_ = replace(SIGINT);
  terminate_ = replace(SIGTERM);
}

InterruptionGuard::~InterruptionGuard() {
  --guards;
  if (!outermost_) return;
  sigaction(SIGINT, &interrupt_, nullptr);
  sigaction(SIGTERM, &terminate_, nullptr);
  if (const int signal = noted_signal.exchange(0)) raise(signal);
}

void throw_if_interrupted() {
  if (const int signal = noted_signal.exchange(0)) throw Interrupted(signal);
}

}  // namespace coppice
