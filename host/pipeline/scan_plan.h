#pragma once

#include "interface/scan.h"
#include "pipeline/build_plan.h"

namespace coppice {

// Where a prefix scan of its own keeps what. The builders' scans are part of their stages.
struct ScanPlan {
  BuildOptions options;  // how it looks back
  std::uint32_t word_count = 0;
  Slot<uvec4> source;  // in: words
  Slot<uvec4> target;  // out: for each word the sum of those before it, modulo 2^32
  Slot<uint> status;   // the ticket and the tiles' words
  Slot<BuildState> state;

  // The places of the words themselves.
  static Slot<uint> words_of(const Slot<uvec4>& quads) { return {quads.place, quads.count * 4}; }
};

// What a scan of so many words takes: quads of them, and words of status.
std::uint64_t scan_quads(std::uint64_t word_count);
std::uint64_t scan_status_words(std::uint64_t word_count);

// The most words of a scan.
inline constexpr std::uint64_t max_scan_words = std::uint64_t{SCAN_MAX_TILES} * SCAN_TILE * 4;

// Throws LayoutError if a slot does not fit a block, std::invalid_argument for more than max_scan_words.
ScanPlan plan_scan(Layout& layout, std::uint64_t word_count, const BuildOptions& options);

// `count_at`: null, or where the device has the number of words, of which at most those planned for are
// scanned; more are ERROR_COUNT.
void append_scan(Chain& chain, const ScanPlan& plan, UintBuffer count_at = {});

}  // namespace coppice
