#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace coppice {

struct AnyField {
  template <class T>
  operator T() const;
};

template <class T, std::size_t... I>
constexpr bool takes_fields(std::index_sequence<I...>) {
  return requires { T{((void)I, AnyField{})...}; };
}

// Number of members of an aggregate of at most 20.
template <class T, std::size_t N = 20>
constexpr std::size_t field_count() {
  if constexpr (takes_fields<T>(std::make_index_sequence<N>{})) {
    return N;
  } else {
    return field_count<T, N - 1>();
  }
}

#define COPPICE_TIE(count, ...)                         \
  if constexpr (field_count<T>() == count) {            \
    auto& [__VA_ARGS__] = object;                       \
    return addresses_of(object, std::tie(__VA_ARGS__)); \
  }

template <class T, class Tuple>
std::vector<std::uint32_t> addresses_of(T& object, const Tuple& members) {
  return std::apply(
      [&](auto&... member) {
        return std::vector<std::uint32_t>{static_cast<std::uint32_t>(
            reinterpret_cast<std::byte*>(&member) - reinterpret_cast<std::byte*>(&object))...};
      },
      members);
}

// Offsets of the members of an aggregate, in order.
template <class T>
std::vector<std::uint32_t> field_offsets() {
  T object{};
  COPPICE_TIE(1, a)
  COPPICE_TIE(2, a, b)
  COPPICE_TIE(3, a, b, c)
  COPPICE_TIE(4, a, b, c, d)
  COPPICE_TIE(5, a, b, c, d, e)
  COPPICE_TIE(6, a, b, c, d, e, f)
  COPPICE_TIE(7, a, b, c, d, e, f, g)
  COPPICE_TIE(8, a, b, c, d, e, f, g, h)
  COPPICE_TIE(9, a, b, c, d, e, f, g, h, i)
  COPPICE_TIE(10, a, b, c, d, e, f, g, h, i, j)
  COPPICE_TIE(11, a, b, c, d, e, f, g, h, i, j, k)
  COPPICE_TIE(12, a, b, c, d, e, f, g, h, i, j, k, l)
  COPPICE_TIE(13, a, b, c, d, e, f, g, h, i, j, k, l, m)
  COPPICE_TIE(14, a, b, c, d, e, f, g, h, i, j, k, l, m, n)
  COPPICE_TIE(15, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o)
  COPPICE_TIE(16, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p)
  COPPICE_TIE(17, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q)
  COPPICE_TIE(18, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r)
  COPPICE_TIE(19, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s)
  COPPICE_TIE(20, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t)
  return {};
}
#undef COPPICE_TIE

}  // namespace coppice
