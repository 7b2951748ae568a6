#include "pipeline/variants.h"

#include <algorithm>

namespace coppice {

namespace {

// In the order of SortVariant.
constexpr std::string_view sort_values[] = {"scan", "scan-8", "scan-11", "onesweep-runs", "onesweep-match"};

// Onesweep reads and writes least; a CPU device is bound by instructions, and counts once where Onesweep
// counts twice.
std::uint32_t sort_rule(const DeviceProperties& device) {
  if (device.type == DeviceType::cpu) return SORT_SCAN;
  return device.subgroup_size >= 16 ? SORT_ONESWEEP_MATCH : SORT_ONESWEEP_RUNS;
}

std::uint32_t sort_without_lookback(std::uint32_t value) {
  return value == SORT_ONESWEEP_RUNS || value == SORT_ONESWEEP_MATCH ? std::uint32_t{SORT_SCAN} : value;
}

// Those through a tree.
constexpr std::span<const std::string_view> trace_values(WALK_NAMES, 3);

// Packets read a node once for all of their rays, which is what costs a CPU device, but for one that ends
// long loops by itself. GPUs hide the time that reads take, and lose by packets what their rays visit in
// vain: Aila and Laine 2009, Ylitie, Karras and Laine 2017.
std::uint32_t trace_rule(const DeviceProperties& device) {
  const auto variant = [](Walk walk) { return static_cast<std::uint32_t>(walk); };
  if (device.type == DeviceType::cpu)
    return variant(device.loop_turn_limit == 0 ? Walk::wide_packets : Walk::binary);
  return variant(device.subgroup_size >= 32 ? Walk::wide_single : Walk::binary);
}

std::uint32_t trace_without_lookback(std::uint32_t value) { return value; }

constexpr VariantStage STAGES_WITH_VARIANTS[] = {
    {"sort", sort_values, &Variants::sort, sort_rule, sort_without_lookback},
    {"trace", trace_values, &Variants::trace, trace_rule, trace_without_lookback}};

std::string set_variant(std::string_view text, Variants& variants) {
  const std::size_t equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  const auto stage = std::ranges::find(STAGES_WITH_VARIANTS, name, &VariantStage::name);
  if (equals == text.npos || stage == std::end(STAGES_WITH_VARIANTS))
    return "'" + std::string(text) + "' names no stage with variants";
  const std::string_view value = text.substr(equals + 1);
  const auto found = std::ranges::find(stage->values, value);
  if (found == stage->values.end())
    return "the stage " + std::string(name) + " has no variant '" + std::string(value) + "'";
  variants.*stage->value = static_cast<std::uint32_t>(found - stage->values.begin());
  return {};
}

}  // namespace

std::span<const VariantStage> variant_stages() { return STAGES_WITH_VARIANTS; }

Variants default_variants(const DeviceProperties& device) {
  Variants variants;
  for (const VariantStage& stage : STAGES_WITH_VARIANTS) variants.*stage.value = stage.rule(device);
  return variants;
}

std::string to_string(const Variants& variants) {
  std::string text;
  for (const VariantStage& stage : STAGES_WITH_VARIANTS) {
    if (!text.empty()) text += ',';
    text += std::string(stage.name) + '=' + std::string(stage.values[variants.*stage.value]);
  }
  return text;
}

std::string set_variants(std::string_view text, Variants& variants) {
  Variants result = variants;
  for (;;) {
    const std::size_t comma = text.find(',');
    if (std::string error = set_variant(text.substr(0, comma), result); !error.empty()) return error;
    if (comma == text.npos) break;
    text.remove_prefix(comma + 1);
  }
  variants = result;
  return {};
}

}  // namespace coppice
