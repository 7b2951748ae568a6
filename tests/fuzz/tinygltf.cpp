// tinygltf compiled with the fuzzers, which cannot look into the system's library.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
// clang-format off: it has no include of its own
#include <tiny_gltf.h>

#include <nlohmann/json.hpp>
// clang-format on
