#pragma once

#include <string>

namespace coppice {

// Why there is no Vulkan device, in one line that says what to install or which setting hides it.
std::string why_no_device();

}  // namespace coppice
