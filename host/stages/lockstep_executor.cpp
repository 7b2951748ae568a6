#include "stages/lockstep_executor.h"

#include <algorithm>
#include <cstdio>

namespace coppice {

namespace {

std::string hexadecimal(const std::byte* bytes, std::uint64_t count) {
  std::string text;
  for (std::uint64_t word = 0; word < count / 4; ++word) {
    std::uint32_t value;
    std::memcpy(&value, bytes + word * 4, 4);
    char digits[10];
    std::snprintf(digits, sizeof digits, "%s%08x", text.empty() ? "" : " ", value);
    text += digits;
  }
  return text;
}

constexpr std::uint64_t piece_bytes = std::uint64_t{1} << 20;
constexpr double step_limit_seconds = 120;

}  // namespace

std::optional<Difference> LockstepExecutor::compare(const char* stage) {
  std::vector<std::byte> piece;
  for (const SlotListing& slot : layout_.slots()) {
    const std::uint64_t bytes = slot.bytes() + Layout::guard_bytes;
    for (std::uint64_t done = 0; done < bytes; done += piece_bytes) {
      piece.resize(std::min(piece_bytes, bytes - done));
      gpu_.arena().download(slot.place.block, slot.place.offset + done, piece);
      const std::byte* const cpu = cpu_.at(slot.place) + done;
      if (std::memcmp(cpu, piece.data(), piece.size()) == 0) continue;
      const auto first = std::mismatch(piece.begin(), piece.end(), cpu).first - piece.begin();
      const std::uint64_t index = (done + first) / slot.element_bytes;
      std::vector<std::byte> element(slot.element_bytes);
      const Place place{slot.place.block, slot.place.offset + index * slot.element_bytes};
      gpu_.arena().download(place.block, place.offset, element);
      return Difference{stage, slot.name, index, hexadecimal(cpu_.at(place), slot.element_bytes),
                        hexadecimal(element.data(), slot.element_bytes)};
    }
  }
  return std::nullopt;
}

void LockstepExecutor::take_over_device_memory() {
  for (const SlotListing& slot : layout_.slots()) {
    gpu_.arena().download(slot.place.block, slot.place.offset, {cpu_.at(slot.place), slot.bytes()});
  }
}

std::optional<Difference> LockstepExecutor::run(const std::function<void(Chain&)>& append,
                                                const Tolerate& tolerate) {
  Chain gpu_chain = gpu_.chain(), cpu_chain = cpu_.chain();
  append(gpu_chain);
  append(cpu_chain);
  for (std::size_t i = 0; i < gpu_chain.steps().size(); ++i) {
    const Step& step = cpu_chain.steps()[i];
    gpu_.record({&gpu_chain.steps()[i], 1}).submit_and_wait(step_limit_seconds);
    cpu_.run(step);
    if (!step.stage) continue;
    ++stages_run_;
    const std::optional<Difference> difference = compare(step.stage->name);
    if (!difference) continue;
    if (!tolerate || !tolerate(*difference)) return difference;
    take_over_device_memory();
  }
  return std::nullopt;
}

}  // namespace coppice
