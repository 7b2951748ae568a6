#pragma once

#include "interface/alpha.h"

namespace coppice::twins {

// Where triangles let one ray through, by the arguments of any trace with alpha; what kernels/lib/alpha.glsl
// is to the kernels. All in float, one rounding an operation.
//
// The place in the map is, in this order, (1 - u - v) a + u b + v c of the corners' texture coordinates; what
// is there is found as texture_colour finds a colour in level 0 (twins/texture.h), in codes from 0 to 255. A
// mask lets the ray through below its threshold. Coverage does where the code is not above the threshold
// times a random number: the upper 24 bits, in 2^-24, of the hash of key and triangle. The key is a hash of
// the six words of origin and direction. The hash of one word is that of PCG (Jarzynski and Olano 2020); that
// of several hashes the exclusive or of the next word and the hash so far, which begins with 0.
class Alpha {
 public:
  Alpha() = default;  // all triangles are solid

  template <class Args>
  Alpha(const Args& args, const Ray& ray)
      : triangles_(args.alpha_triangles),
        maps_(args.alpha_maps),
        texels_(args.alpha_texels),
        key_(key_of(ray)) {}

  bool lets_through(const Hit& hit) const;

 private:
  static uint key_of(const Ray& ray);
  float texel(const AlphaMap& map, long x, long y) const;
  float code_at(const AlphaMap& map, vec2 place) const;

  Address<const AlphaTriangle> triangles_{};
  Address<const AlphaMap> maps_{};
  Address<const uint> texels_{};
  uint key_ = 0;
};

}  // namespace coppice::twins
