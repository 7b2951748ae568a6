#pragma once

#include <filesystem>

#include "measure/bench.h"
#include "measure/json.h"
#include "measure/table.h"

namespace coppice {

// What measurement says of a stage that has variants.
struct TunedStage {
  const VariantStage* stage;
  std::uint32_t chosen;   // kept in the device's variants
  std::uint32_t fastest;  // by the least median
  bool sure;              // whether measurement decided, and not noise
  std::uint32_t rule;     // what the stage's rule says of this device
  Table variants;         // a row each that can run here
};

// An empty table of variants.
Table tuning_table();

// Measures the stage's variants by turns and keeps in the device's what is faster for sure, or else the
// rule's. Sizes and runs are those of the options, and scenes the default one. Throws DeviceError if a result
// is wrong.
TunedStage tune_stage(CheckedDevice& device, const VariantStage& stage, const BenchOptions& options);
Json to_json(const TunedStage& tuned);

// Where the device's table of variants goes, found fit for it before minutes are spent. Throws InputError.
std::filesystem::path checked_table_file(const Device& device);

}  // namespace coppice
