#pragma once

#include <concepts>
#include <type_traits>

namespace coppice {

// How many parts of size b hold a. No overflow on the way.
template <std::unsigned_integral T>
constexpr T divide_up(T a, std::type_identity_t<T> b) {
  return a / b + (a % b != 0);
}

}  // namespace coppice
