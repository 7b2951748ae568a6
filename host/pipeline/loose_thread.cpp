#include "pipeline/loose_thread.h"

#include <atomic>
#include <thread>
#include <utility>

namespace coppice {

namespace {

std::atomic<int> loose_threads = 0;

}  // namespace

void start_loose_thread(std::function<void()> work) {
  ++loose_threads;
  try {
    std::thread([work = std::move(work)] {
      work();
      --loose_threads;
    }).detach();
  } catch (...) {
    --loose_threads;  // there is none
    throw;
  }
}

bool has_loose_threads() { return loose_threads > 0; }

}  // namespace coppice
