#include "builders/threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <optional>

namespace coppice {

namespace tbb = oneapi::tbb;

struct Threads::Arena {
  explicit Arena(int count) : arena(count) {
    // TBB starts no more threads than there are processors unless it is told to.
    if (count > tbb::info::default_concurrency()) {
      control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
    }
  }
  std::optional<tbb::global_control> control;
  tbb::task_arena arena;
};

Threads::Threads(std::uint32_t count) {
  constexpr std::uint32_t most = 1024;
  const int threads = count == 0 ? tbb::info::default_concurrency() : static_cast<int>(std::min(count, most));
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}

Threads::~Threads() = default;

void Threads::for_each(std::size_t count, const std::function<void(std::size_t)>& work) const {
  if (!arena_ || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
        },
        tbb::simple_partitioner());
  });
}

void Threads::for_each_chunk(std::size_t count, std::size_t size,
                             const std::function<void(Chunk, std::size_t)>& work) const {
  for_each(chunk_count(count, size), [&](std::size_t k) {
    const std::size_t begin = k * size;
    work({begin, std::min(begin + size, count)}, k);
  });
}

}  // namespace coppice
