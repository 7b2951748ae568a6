// tinygltf compiled with the fuzzers, which cannot look into the system's library.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
// It does not include the first one itself.
// clang-format off
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>
// clang-format on
