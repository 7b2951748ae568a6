#include "stages/lockstep_executor.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace coppice {

namespace {

std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    std::uint32_t value;
    std::memcpy(&value, &bytes[at], 4);
    char digits[10];
    std::snprintf(digits, sizeof digits, "%s%08x", text.empty() ? "" : " ", value);
    text += digits;
  }
  return text;
}

const NearlySlot* find_nearly(const StageDeclaration* stage, const SlotListing& slot) {
  if (!stage) return nullptr;
  const auto found = std::ranges::find_if(
      stage->nearly, [&](const NearlySlot& one) { return std::string_view(one.slot) == slot.name; });
  return found == stage->nearly.end() ? nullptr : &*found;
}

void add(NearlyEqual& sum, const NearlyEqual& one) {
  sum.count += one.count;
  sum.differing += one.differing;
  sum.beyond += one.beyond;
  sum.beyond_allowed += one.beyond_allowed;
  sum.tied += one.tied;
  sum.tied_allowed += one.tied_allowed;
  sum.largest_relative_t = std::max(sum.largest_relative_t, one.largest_relative_t);
}

std::string explain(const NearlyEqual& found) {
  std::string text = std::to_string(found.beyond) + " of " + std::to_string(found.count) +
                     " differ by more than the tolerance, " + std::to_string(found.beyond_allowed) + " may";
  if (found.tied > found.tied_allowed) {
    text += "; " + std::to_string(found.tied) + " are of another triangle at the same distance, " +
            std::to_string(found.tied_allowed) + " may";
  }
  return text;
}

constexpr std::uint64_t piece_bytes = std::uint64_t{1} << 20;
constexpr double step_limit_seconds = 120;

}  // namespace

LockstepExecutor::LockstepExecutor(Device& device, const Layout& layout)
    : layout_(layout),
      gpu_(device, layout),
      cpu_(layout),
      every_bit_(rounds_like_the_host(device.properties())) {}

std::optional<Difference> LockstepExecutor::compare_bits(const char* name, const SlotListing& slot,
                                                         std::uint64_t first, std::uint64_t end) {
  std::vector<std::byte> piece;
  for (std::uint64_t done = first; done < end; done += piece_bytes) {
    piece.resize(std::min(piece_bytes, end - done));
    gpu_.arena().download(slot.place.block, slot.place.offset + done, piece);
    const std::byte* const cpu = cpu_.at(slot.place) + done;
    if (std::memcmp(cpu, piece.data(), piece.size()) == 0) continue;
    const auto at = std::mismatch(piece.begin(), piece.end(), cpu).first - piece.begin();
    const std::uint64_t index = (done + at) / slot.element_bytes;
    const std::uint64_t begin = index * slot.element_bytes;
    std::vector<std::byte> element(std::min(slot.element_bytes, end - begin));
    gpu_.arena().download(slot.place.block, slot.place.offset + begin, element);
    return Difference{name,
                      slot.name,
                      index,
                      hexadecimal({cpu_.at(slot.place) + begin, element.size()}),
                      hexadecimal(element),
                      {}};
  }
  return std::nullopt;
}

std::optional<Difference> LockstepExecutor::compare_slot(const StageDeclaration& stage,
                                                         const NearlySlot& nearly, const SlotListing& slot) {
  const std::span<std::byte> cpu(cpu_.at(slot.place), slot.bytes());
  std::vector<std::byte> gpu(slot.bytes());
  gpu_.arena().download(slot.place.block, slot.place.offset, gpu);
  const NearlyEqual found = compare_nearly(nearly.like, cpu, gpu);
  if (!found.holds()) {
    const std::uint64_t at = *found.first * slot.element_bytes;
    return Difference{stage.name,
                      slot.name,
                      *found.first,
                      hexadecimal(cpu.subspan(at, slot.element_bytes)),
                      hexadecimal(std::span(gpu).subspan(at, slot.element_bytes)),
                      explain(found)};
  }
  const auto listed = std::ranges::find_if(
      nearly_, [&](const NearlyListing& one) { return one.stage == stage.name && one.slot == nearly.slot; });
  if (listed == nearly_.end()) {
    nearly_.push_back({stage.name, nearly.slot, found});
  } else {
    add(listed->sum, found);
  }
  std::ranges::copy(gpu, cpu.begin());
  return std::nullopt;
}

std::optional<Difference> LockstepExecutor::compare(const StageDeclaration* stage, const char* name) {
  for (const SlotListing& slot : layout_.slots()) {
    const std::uint64_t end = layout_.end_of_slot(slot.place);  // behind it lie a gap and the guard
    std::uint64_t first = 0;
    const NearlySlot* const nearly = every_bit_ ? nullptr : find_nearly(stage, slot);
    if (nearly) {
      if (auto difference = compare_slot(*stage, *nearly, slot)) return difference;
      first = slot.bytes();
    }
    if (auto difference = compare_bits(name, slot, first, end - slot.place.offset)) return difference;
  }
  return std::nullopt;
}

std::optional<Difference> LockstepExecutor::run(const std::function<void(Chain&)>& append) {
  Chain gpu_chain = gpu_.chain(), cpu_chain = cpu_.chain();
  append(gpu_chain);
  append(cpu_chain);
  if (auto difference = compare(nullptr, "upload")) return difference;
  const std::span<const Step> gpu_steps = gpu_chain.steps(), cpu_steps = cpu_chain.steps();
  for (std::size_t i = 0, end = 0; i < cpu_steps.size(); i = end) {
    const bool nothing = cpu_.does_nothing(cpu_steps[i]);
    end = i + 1;
    while (nothing && end < cpu_steps.size() && cpu_.does_nothing(cpu_steps[end])) ++end;
    gpu_.record(gpu_steps.subspan(i, end - i)).submit_and_wait(step_limit_seconds);
    cpu_.run(cpu_steps.subspan(i, end - i));
    for (const Step& step : cpu_steps.subspan(i, end - i)) stages_run_ += stage_of(step) ? 1 : 0;
    const StageDeclaration* const stage = nothing ? nullptr : stage_of(cpu_steps[i]);
    const char* const name = nothing ? "steps of no workgroups" : stage ? stage->name : "clear";
    if (auto difference = compare(stage, name)) return difference;
  }
  return std::nullopt;
}

}  // namespace coppice
