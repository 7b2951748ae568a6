#pragma once

#include <cstdint>
#include <span>

namespace coppice {

// A stage as an executor needs it: its name, its kernel as SPIR-V and its twin, which takes the same Args
// with host addresses in them.
struct StageDeclaration {
  const char* name;
  std::span<const std::uint32_t> kernel;
  void (*twin)(const void* args);
};

// The same, typed by its Args struct.
template <class Args>
struct Stage : StageDeclaration {};

}  // namespace coppice
