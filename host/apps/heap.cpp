// The allocator of the whole program: malloc, and advice to the kernel of what becomes large.
#include "apps/heap.h"

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#include <sys/mman.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::size_t huge_page = 2 << 20;  // of most systems; elsewhere the advice is less exact
constexpr std::size_t large_block = 64 << 10;

// All huge pages that the block touches, whatever else lies there, and the next: malloc writes its books
// behind a block before we hear of it, and a huge page that was touched before it was advised stays small.
void advise_huge_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t size) {
#ifdef MADV_HUGEPAGE
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = address / huge_page * huge_page;
  const std::uintptr_t end = (address + size) / huge_page * huge_page + 2 * huge_page;
  const int error = errno;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // may well be refused
  errno = error;
#endif
}

}  // namespace

namespace coppice {

void settle_heap() {
#ifdef M_MMAP_MAX
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  // Of the heap, and of each thread's arena, which it makes as large as it can be: grown by less they would
  // often end in the middle of a huge page. It is address space, and memory only where it is touched.
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace coppice

void* operator new(std::size_t size) {
  void* const block = std::malloc(size > 0 ? size : 1);
  if (!block) throw std::bad_alloc();
  if (size >= large_block) advise_huge_pages(block, size);
  return block;
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
