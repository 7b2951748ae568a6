#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "interface/types.h"

namespace coppice {

// An address among the arguments of a stage.
struct AddressArg {
  std::uint32_t offset;  // bytes, in the Args
  bool written;          // may be; else it is READS(...)
};

namespace detail {

template <class T>
inline constexpr bool is_address = false;
template <class T>
inline constexpr bool is_address<Address<T>> = true;

struct AddressArgList {
  static constexpr std::size_t most = 16;
  std::array<AddressArg, most> args{};
  std::size_t count = 0, bytes = 0;

  template <class T>
  constexpr void add() {
    bytes = (bytes + alignof(T) - 1) / alignof(T) * alignof(T);
    if constexpr (is_address<T>)
      args[count++] = {static_cast<std::uint32_t>(bytes), !std::is_same_v<T, typename T::ReadOnly>};
    bytes += sizeof(T);
  }
};

// Is taken for any member of an Args, and notes which one it was.
struct ArgProbe {
  AddressArgList* list;

  template <class T>
  requires(is_address<T> || std::same_as<T, uint>) constexpr operator T() const {
    if (list) list->add<T>();
    return T{};
  }
};

template <class Args, std::size_t... I>
constexpr bool has_members(std::index_sequence<I...>) {
  return requires { Args{((void)I, ArgProbe{})...}; };
}

template <class Args, std::size_t Members = sizeof(Args) / sizeof(uint)>
consteval AddressArgList list_address_args() {
  if constexpr (!has_members<Args>(std::make_index_sequence<Members>{})) {
    return list_address_args<Args, Members - 1>();
  } else {
    AddressArgList list;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      static_cast<void>(Args{((void)I, ArgProbe{&list})...});
    }
    (std::make_index_sequence<Members>{});
    return list;
  }
}

}  // namespace detail

// The addresses of an Args, whose members are addresses and words, in their order.
template <class Args>
inline constexpr auto address_args_of = [] {
  constexpr detail::AddressArgList list = detail::list_address_args<Args>();
  static_assert(list.count > 0 && list.bytes == sizeof(Args));
  std::array<AddressArg, list.count> args{};
  for (std::size_t i = 0; i < list.count; ++i) args[i] = list.args[i];
  return args;
}();

}  // namespace coppice
