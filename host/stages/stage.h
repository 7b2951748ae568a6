#pragma once

#include <cstdint>
#include <span>

namespace coppice {

// What of a stage's result may differ between a GPU and the twin, because it divides or takes a square root,
// which Vulkan lets be off by some ulps. The limits are in stages/nearly.h.
enum class Nearly { rays, hits, counters, radiance, image };

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
  // Slots that it writes nearly alike; all others hold the same bits on every device.
  std::span<const NearlySlot> nearly;
};

// The same, typed by its Args struct.
template <class Args>
struct Stage : StageDeclaration {};

}  // namespace coppice
