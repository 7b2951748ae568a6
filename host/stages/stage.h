#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "stages/address_args.h"

namespace coppice {

struct RunCounts;

// What of a stage's result may differ between a GPU and the twin, because it divides or takes a square root,
// which Vulkan lets be off by some ulps. The limits are in stages/nearly.h.
enum class Nearly {
  rays,
  hits,
  any_hits,
  hit_instances,
  candidates,
  candidate_counts,
  counters,
  radiance,
  noise,
  image,
  surfaces,
  paths
};

struct NearlySlot {
  const char* slot;
  Nearly like;
};

// A stage as an executor needs it: its name, its kernel as SPIR-V and its twin, which takes the same Args
// with host addresses in them.
struct StageDeclaration {
  const char* name;
  std::span<const std::uint32_t> kernel;
  void (*twin)(const void* args);
  // Bytes that it must read and write at least, once each, in a run that left these counts.
  std::uint64_t (*traffic)(const void* args, const RunCounts& counts);
  // Slots that it writes nearly alike; all others hold the same bits on every device.
  std::span<const NearlySlot> nearly;
  // Where its Args have the memory that it reads and writes.
  std::span<const AddressArg> addresses;
};

// The same, typed by its Args struct and by the struct of its kernel's specialization constants 0, 1, ...,
// a word each.
template <class Args, class Constants>
struct Stage : StageDeclaration {};

// Of a kernel that has none.
struct NoConstants {};

// Specialization constants 0, 1, ... of a kernel.
struct KernelConstants {
  std::array<std::uint32_t, 8> words{};
  std::uint32_t count = 0;

  KernelConstants() = default;

  template <class Constants>
  explicit KernelConstants(const Constants& constants) {
    static_assert(std::is_trivially_copyable_v<Constants>);
    if constexpr (!std::is_empty_v<Constants>) {
      static_assert(sizeof(Constants) <= sizeof words && sizeof(Constants) % 4 == 0);
      count = sizeof(Constants) / 4;
      std::memcpy(words.data(), &constants, sizeof(Constants));
    }
  }

  std::span<const std::uint32_t> span() const { return {words.data(), count}; }
  auto operator<=>(const KernelConstants&) const = default;
};

}  // namespace coppice
