#include "gpu/no_driver.h"

#include <dlfcn.h>

#include <cstdlib>

#include "gpu/vulkan_context.h"

namespace coppice {

PFN_vkGetInstanceProcAddr loader_entry() {
  // Never closed: drivers leave threads and handlers behind.
  static void* const library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  void* const entry = library ? dlsym(library, "vkGetInstanceProcAddr") : nullptr;
  if (!entry) throw DeviceError("no Vulkan loader, libvulkan.so.1: install the Debian package libvulkan1");
  return reinterpret_cast<PFN_vkGetInstanceProcAddr>(entry);
}

std::string why_no_device() {
  try {
    loader_entry();
  } catch (const DeviceError& error) {
    return error.what();
  }
  std::string settings;  // each can keep the loader from drivers that are there
  for (const char* const name :
       {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"}) {
    if (const char* const value = std::getenv(name); value && *value)
      settings.append(settings.empty() ? " with " : " and ").append(name).append("=").append(value);
  }
  return "no Vulkan device found" + settings + ": " + (settings.empty() ? "" : "unset that, or ") +
         "install the Debian package mesa-vulkan-drivers, which needs no GPU";
}

}  // namespace coppice
