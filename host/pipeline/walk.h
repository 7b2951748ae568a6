#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace coppice {

// How rays look for what they hit. All find the same hits.
enum class Walk : std::uint32_t {
  binary,        // through the binary tree
  wide_packets,  // through the wide tree, in packets of a subgroup
  wide_single,   // through the wide tree, each ray by itself
  brute_force,   // no tree: every triangle is tested
};

// The name of each, in their order.
inline constexpr std::string_view WALK_NAMES[] = {"binary", "wide-packets", "wide-single", "brute-force"};

constexpr std::string_view name_of(Walk walk) { return WALK_NAMES[static_cast<std::uint32_t>(walk)]; }

constexpr bool is_wide(Walk walk) { return walk == Walk::wide_packets || walk == Walk::wide_single; }

// What a caller asks for: one walk, or any through the wide tree, or what suits the device and the picture.
struct WalkChoice {
  std::optional<Walk> walk;
  bool any_wide = false;
  std::string said = "the wide tree";  // what messages call the choice

  bool automatic() const { return !walk && !any_wide; }
  // The binary walk is the only one that knows two levels.
  bool allows_binary() const { return !any_wide && walk.value_or(Walk::binary) == Walk::binary; }
};

}  // namespace coppice
