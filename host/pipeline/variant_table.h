#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "pipeline/variants.h"

namespace coppice {

// A table of variants is a text file: a line with the format's version, the device's and the driver's name,
// and a line with a variant for each stage that has some. `coppice tune` writes it.

std::string variant_table_text(const Variants& variants, const DeviceProperties& device);

// Sets what the table says; empty, or what is wrong with it: not of this format, device or driver, a stage
// missing, double or unknown. Then `variants` stay as they were.
std::string parse_variant_table(const std::string& text, const DeviceProperties& device, Variants& variants);

// The table of this device, or the rules' choice where there is none. `note` takes a line for a table of no
// use.
Variants variants_of(const Device& device, const std::function<void(const std::string&)>& note);

}  // namespace coppice
