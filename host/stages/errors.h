#pragma once

#include <cstdint>
#include <string>

namespace coppice {

// What the bits of BuildState::error_word mean, each with its stage; empty for zero.
std::string describe_error_word(std::uint32_t error_word);

}  // namespace coppice
