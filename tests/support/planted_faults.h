#pragma once

#include <cstdint>

#include "interface/lookback.h"
#include "stages/stage.h"

namespace coppice {

// A stage with a twin that does its work and one thing wrong.
template <const auto* stage, auto spoil>
StageDeclaration faulty() {
  StageDeclaration declaration = *stage;
  declaration.twin = [](const void* args) {
    stage->twin(args);
    spoil(args);
  };
  return declaration;
}

// What `spoil` is given.
template <class Args>
Args args_of(const void* args) {
  return *static_cast<const Args*>(args);
}

// A value of LOOKBACK_STRESS by which so many tiles never report.
constexpr std::uint32_t silent(std::uint32_t tiles) { return tiles << LOOKBACK_SILENT_SHIFT; }

}  // namespace coppice
