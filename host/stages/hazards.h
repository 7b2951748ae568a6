#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "stages/chain.h"
#include "stages/layout.h"

namespace coppice {

// Where in an address space the arrays end that steps are given addresses of.
class AddressMap {
 public:
  // Both must outlive it. Of blocks behind those of the layout nothing is known but where they begin.
  AddressMap(const Layout& layout, std::span<const std::uint64_t> block_addresses)
      : layout_(layout), block_addresses_(block_addresses) {}

  std::uint64_t address_of(const Place& place) const { return block_addresses_[place.block] + place.offset; }

  // Of the slot that holds this address; of all memory where that is not known.
  std::uint64_t end_of(std::uint64_t address) const;

 private:
  const Layout& layout_;
  std::span<const std::uint64_t> block_addresses_;
};

// Follows the steps of a chain, and knows which of them may overlap: those that write nothing that another
// one reads or writes. What a step reads and writes its Args say.
class Hazards {
 public:
  // Steps that are timed one by one stand apart, but for clears that follow each other.
  enum class Overlap { steps, clears };

  explicit Hazards(const AddressMap& map, Overlap overlap = Overlap::steps) : map_(map), overlap_(overlap) {}

  // Whether a barrier must precede this step, behind those of the calls before: the first step needs one, and
  // so does the first one behind a mark. Allocates nothing.
  bool needs_barrier(const Step& step);

 private:
  struct Touch {
    std::uint64_t begin = 0, end = 0;  // 0: not looked up yet
    bool writes = false;
  };
  struct StepTouches {
    std::array<Touch, 17> touches{};
    std::size_t count = 0;
  };

  StepTouches touches_of(const Step& step) const;
  bool meet(Touch& a, Touch& b) const;
  bool meets_earlier(StepTouches& step);

  AddressMap map_;
  Overlap overlap_;
  std::array<Touch, 128> touches_{};  // of the steps behind the last barrier
  std::size_t count_ = 0;             // of them; none where the next step needs a barrier
  bool after_clear_ = false;
};

}  // namespace coppice
