#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <string>

namespace coppice {

// What lies beyond the image.
enum class TextureWrap : std::uint32_t { repeat, clamp, mirror };

// An image that a material names, and how it lies on a surface. Nothing of it is opened or decoded here.
struct TextureMap {
  std::string name;    // of a file as written, or the JSON pointer of an embedded image; empty: no map
  std::string folder;  // that of the file that names it, where the name leads on from
  std::shared_ptr<const std::string>
      bytes{};  // an embedded image's file, empty for a broken one; null: a file
  TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
  // Texture coordinates times `scale` plus `offset` are places in the image, (0, 0) its upper left corner and
  // (1, 1) the lower right one. By default as in OBJ files, whose origin is the lower left corner.
  glm::vec2 scale{1.0f, -1.0f}, offset{0.0f, 1.0f};
  // Of a map of single numbers, which channel: r, g, b, m (alpha), l (luminance) or z; 0 where nothing says.
  char channel = 0;
  float strength = 1;  // of a bump or normal map
  // Of a map of colours from a format that has no alpha mode: an image that is a cut-out cuts the surface out
  // (find_cut_outs).
  bool may_cut_out = false;

  explicit operator bool() const { return !name.empty(); }
  bool operator==(const TextureMap&) const = default;
};

}  // namespace coppice
