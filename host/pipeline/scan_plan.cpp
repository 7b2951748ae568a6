#include "pipeline/scan_plan.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

constexpr std::uint64_t first_tile_word =
    4;  // of the status, behind the ticket: tiles' sums are scanned as quads
static_assert(SCAN_MAX_TILES <= SCAN_TILE * 4 && SCAN_MAX_TILES <= 65535);

}  // namespace

std::uint64_t scan_quads(std::uint64_t word_count) { return divide_up(word_count, 4); }

std::uint64_t scan_status_words(std::uint64_t word_count) {
  return first_tile_word + divide_up(divide_up(scan_quads(word_count), SCAN_TILE) * SCAN_SUMS, 4) * 4;
}

ScanPlan plan_scan(Layout& layout, std::uint64_t word_count, const BuildOptions& options) {
  if (word_count > max_scan_words) {
    throw std::invalid_argument(std::to_string(word_count) + " words are more than a scan takes, " +
                                std::to_string(max_scan_words));
  }
  const std::uint64_t quads = scan_quads(word_count);
  ScanPlan plan;
  plan.options = options;
  plan.word_count = static_cast<std::uint32_t>(word_count);
  plan.source = layout.add<uvec4>("scan_source", quads, Memory::source);
  plan.target = layout.add<uvec4>("scan_target", quads, Memory::target);
  plan.status = layout.add<uint>("scan_status", scan_status_words(word_count));
  plan.state = layout.add<BuildState>("state", 1);
  return plan;
}

void append_scan(Chain& chain, const ScanPlan& plan, UintBuffer count_at) {
  const std::uint32_t words = plan.word_count, tiles = divide_up(words, SCAN_TILE * 4);
  const auto source = chain.at(plan.source), target = chain.at(plan.target);
  const auto ticket = chain.at(plan.status), status = chain.at(plan.status, first_tile_word);
  const auto state = chain.at(plan.state);
  chain.clear(plan.status);
  if (!plan.options.lookback) {
    const Address<uvec4> sums{status.value};
    chain.run(stages::scan_tile_sums, {source, status, count_at, words, 0}, {tiles, 1, 1});
    // One tile, so in place; before it is nothing, as the unused ticket says. Tiles without words have a sum
    // of 0.
    chain.run(stages::prefix_scan, {sums, sums, ticket, ticket, state, {}, tiles, 0},
              {tiles > 0 ? 1u : 0u, 1, 1});
  }
  chain.run(stages::prefix_scan,
            {source, target, status, ticket, state, count_at, words, plan.options.lookback},
            {std::max(tiles, count_at.value ? 1u : 0u), 1, 1}, lookback_constants(plan.options));
}

}  // namespace coppice
