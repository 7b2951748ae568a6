#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gpu/vulkan_context.h"

namespace coppice {

// Compiled pipelines, kept in a file between runs: its name holds the device and the driver. A file that is
// not there, not whole, or of another driver counts as none, and a folder that cannot be written is left
// alone: the run is slower and not wrong.

// The name of a file of this device and driver.
std::string file_name_of(std::string_view stem, const vk::raii::PhysicalDevice& physical);

// Makes context.pipeline_cache of what the file holds, if anything. The folder may be empty: nothing is kept.
void load_pipelines(VulkanContext& context, const std::filesystem::path& folder);

// Writes the file, whole or not at all, if it would change.
void store_pipelines(const VulkanContext& context) noexcept;

}  // namespace coppice
