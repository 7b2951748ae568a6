#include "stages/hazards.h"

#include <algorithm>
#include <cstring>

namespace coppice {

std::uint64_t AddressMap::end_of(std::uint64_t address) const {
  const std::vector<std::uint64_t>& bytes = layout_.block_bytes();
  std::uint64_t end = ~std::uint64_t{0}, least_offset = end;
  for (std::uint32_t block = 0; block < bytes.size(); ++block) {
    const std::uint64_t offset = address - block_addresses_[block];  // huge for what lies before the block
    if (offset >= bytes[block] || offset >= least_offset) continue;
    // A caller's array may be shorter than its block by the guard, and another one begin there: the nearest.
    least_offset = offset;
    end = address_of({block, layout_.end_of_slot({block, offset})});
  }
  return end;
}

Hazards::StepTouches Hazards::touches_of(const Step& step) const {
  StepTouches touched;
  const auto add = [&](std::uint64_t begin, std::uint64_t end, bool writes) {
    touched.touches[touched.count++] = {begin, end, writes};
  };
  if (const Clear* const clear = std::get_if<Clear>(&step)) {
    const std::uint64_t begin = map_.address_of(clear->place);
    add(begin, begin + clear->bytes, true);
  } else if (const Dispatch* const dispatch = dispatch_of(step)) {
    for (const AddressArg& arg : dispatch->stage->addresses) {
      std::uint64_t address;
      std::memcpy(&address, &dispatch->args[arg.offset], sizeof address);
      if (address != 0) add(address, 0, arg.written);
    }
    if (dispatch->indirect) {
      const std::uint64_t begin = map_.address_of(*dispatch->indirect);
      add(begin, begin + sizeof(uvec3), false);
    }
  }
  return touched;
}

bool Hazards::meet(Touch& a, Touch& b) const {
  if (!a.writes && !b.writes) return false;
  for (Touch* const touch : {&a, &b}) {
    if (touch->end == 0) touch->end = map_.end_of(touch->begin);
  }
  return a.begin < b.end && b.begin < a.end;
}

bool Hazards::meets_earlier(StepTouches& step) {
  const auto earlier = std::span(touches_).first(count_);
  const auto mine = std::span(step.touches).first(step.count);
  // Most steps go on with what the one before has written, whose beginning tells that at once.
  for (const Touch& touch : mine) {
    for (const Touch& other : earlier) {
      if (touch.begin == other.begin && (touch.writes || other.writes)) return true;
    }
  }
  for (Touch& touch : mine) {
    for (Touch& other : earlier) {
      if (meet(touch, other)) return true;
    }
  }
  return false;
}

bool Hazards::needs_barrier(const Step& step) {
  if (std::holds_alternative<Mark>(step)) {
    count_ = 0;
    return false;
  }
  StepTouches touched = touches_of(step);
  const bool clears = std::holds_alternative<Clear>(step);
  const bool stands_apart = overlap_ == Overlap::clears && !(clears && after_clear_);
  after_clear_ = clears;
  const bool barrier =
      count_ == 0 || stands_apart || touched.count > touches_.size() - count_ || meets_earlier(touched);
  if (barrier) count_ = 0;
  std::ranges::copy_n(touched.touches.begin(), static_cast<std::ptrdiff_t>(touched.count),
                      touches_.begin() + count_);
  count_ += touched.count;
  return barrier;
}

}  // namespace coppice
