#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "scene/gltf_document.h"

namespace coppice {

// Reads accessors of any layout: interleaved, sparse, without a buffer view (zeros). tinygltf checks no
// ranges, so every offset, count and type is checked here. `user` is the JSON pointer of what names the
// accessor.
class GltfAccessors {
 public:
  explicit GltfAccessors(const GltfDocument& document) : document_(document) {}

  std::size_t count(int accessor, const std::string& user) const;

  // count * components numbers; `type` is "VEC3" and the like. Integers are read as the numbers they are, or,
  // where the accessor says normalized, as -1 to 1 (glTF 2.0, 3.11).
  std::vector<float> floats(int accessor, const char* type, const std::string& user) const;

  // The same of unsigned bytes, shorts and words, `most_bytes` wide at most.
  std::vector<std::uint32_t> integers(int accessor, const char* type, int most_bytes,
                                      const std::string& user) const;

 private:
  // Where elements lie. data is null for zeros.
  struct Elements {
    const unsigned char* data = nullptr;
    std::size_t stride = 0, count = 0;
    int component_type = 0, components = 0;
    bool normalized = false;
  };
  Elements in_view(const std::string& pointer, int view, std::size_t offset, Elements elements) const;
  Elements elements_of(int accessor, const char* type, const std::string& user) const;
  template <class T>
  std::vector<T> read(int accessor, const char* type, const std::string& user) const;

  const GltfDocument& document_;
};

}  // namespace coppice
