#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gpu/device.h"
#include "pipeline/walk.h"

namespace coppice {

// How the sort is done. All give the same order.
enum SortVariant : std::uint32_t {
  SORT_SCAN,            // counts, scans and scatters; digits of 11 bits for few keys, of 8 for many
  SORT_SCAN_8,          // always of 8
  SORT_SCAN_11,         // always of 11
  SORT_ONESWEEP_RUNS,   // tile prefixes by lookback; each invocation ranks a run of keys one by one
  SORT_ONESWEEP_MATCH,  // the same; a subgroup ranks its keys by ballots
};

// Which of the variants of each stage runs. No result depends on it.
struct Variants {
  std::uint32_t sort = SORT_ONESWEEP_RUNS;
  std::uint32_t trace = 0;  // a Walk through a tree

  Walk walk() const { return Walk{trace}; }

  bool operator==(const Variants&) const = default;
};

// A stage that has variants: to add one takes a line in variants.cpp and a member of Variants.
struct VariantStage {
  std::string_view name;
  std::span<const std::string_view> values;  // in the order of the numbers
  std::uint32_t Variants::*value;
  std::uint32_t (*rule)(const DeviceProperties&);  // without a table of measurements
  // What runs in place of a variant where there is no lookback: itself, if it needs none.
  std::uint32_t (*without_lookback)(std::uint32_t value);
};

std::span<const VariantStage> variant_stages();

// What the rules choose, by properties of the device.
Variants default_variants(const DeviceProperties& device);

// "sort=scan", with commas between stages.
std::string to_string(const Variants& variants);

// Sets what "STAGE=VALUE,..." says; empty, or what is wrong with it.
std::string set_variants(std::string_view text, Variants& variants);

}  // namespace coppice
