#pragma once

#include <cstdint>
#include <string>

namespace coppice {

// Drivers of CPU devices compile kernels in this process, and some crash or hang where they get no memory for
// it: better to ask before. Throws DeviceError if the address space has no so many bytes left in one piece;
// `beside` begins the line's reason, "" or "beside ... ".
void check_address_space(std::uint64_t bytes, const std::string& beside);

}  // namespace coppice
