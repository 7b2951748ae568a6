#pragma once

#include "gpu/vulkan_context.h"

namespace coppice {

using FeatureChain = vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                        vk::PhysicalDeviceVulkan13Features>;

// Those that are needed, and no others.
FeatureChain required_features();

// Empty for an instance that was made for Vulkan 1.3.
std::string why_unsuitable(const vk::raii::Instance& instance);

// The version, limit or feature that a device lacks, in words; empty for one that can be used.
std::string why_unsuitable(const vk::raii::PhysicalDevice& physical);

DeviceType device_type(vk::PhysicalDeviceType type);
DeviceListing listing_of(const vk::raii::PhysicalDevice& physical, std::uint32_t index);

// The index of the device that `select` names, as DeviceOptions::select; throws DeviceError for none.
std::uint32_t choose_device(const std::vector<DeviceListing>& devices, const std::string& select);

}  // namespace coppice
