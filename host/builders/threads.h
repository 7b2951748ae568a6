#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace coppice {

// A run of indices.
struct Chunk {
  std::size_t begin, end;
  std::size_t count() const { return end - begin; }
};

// The threads of a builder, from oneTBB. Work comes in chunks whose borders depend on the input alone, so
// that results do not depend on the number of threads.
class Threads {
 public:
  // 0: as many as the machine runs at once. 1: the caller's, without TBB.
  explicit Threads(std::uint32_t count);
  ~Threads();

  // Calls `work` for each of 0, 1, ..., count - 1, at once and in any order; returns when all are done.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work) const;

  // Calls work(chunk, k) for each chunk k of `size` of the indices below `count`; the last one may be
  // smaller.
  void for_each_chunk(std::size_t count, std::size_t size,
                      const std::function<void(Chunk, std::size_t)>& work) const;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;  // none for one thread
};

// How many chunks of `size` cover the indices below `count`.
constexpr std::size_t chunk_count(std::size_t count, std::size_t size) { return (count + size - 1) / size; }

}  // namespace coppice
