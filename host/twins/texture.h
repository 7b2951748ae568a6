#pragma once

#include <glm/vec4.hpp>

#include "interface/texture.h"

namespace coppice::twins {

// What kernels/lib/texture.glsl and texture_level.glsl have, written from this contract: all in float, one
// rounding an operation.

// The texture `which` at `uv`. The place is uv * scale + offset; one that is below 2^-60, from 2^23 on, or no
// number, is 0; it is then brought to 0 to 1 by the wrap mode. Of a level of so many texels a side, the point
// place * side - 0.5 lies between two texels of each axis, which beyond the edge repeat or stay; the part of
// the way to the second is the point less its floor. Between two colours: first + (second - first) * part;
// along u, then along v, then between levels. Codes become colours by `linear`, 256 of them, numbers by *
// 0.003921569. `level` is clamped to the levels; below 2^-20, or NaN, it is 0.
glm::vec4 texture_colour(const Address<const TextureHeader>& headers, const Address<const uint>& texels,
                         const Address<const float>& linear, uint which, vec2 uv, float level);

// log2 to within 0.00014: of 2^e (1 + m) it is e + (m + m (1 - m) (c0 + m (c1 + m c2))). -126 for what is not
// positive, denormal or NaN, and 128 for infinity.
float log2_by_bits(float x);

// |b.x c.y - b.y c.x| of the edges from a, in which components below 2^-60 are 0. Infinity, as of triangles,
// where that is not finite.
float twice_texcoord_area(const CornerAttributes& corners);

// The length of the cross product of such edges, its components divided by the largest, which is multiplied
// at the end; 0 where that is below 2^-100.
float twice_area(const Triangle& triangle);

float cone_width_at(float width, float spread, float distance);

// 0.5 (log2 uv area - log2 area) + (log2 width - log2 cosine): the level less the texture's part, which is
// half of log2(width * height * |scale.x * scale.y|).
float surface_level(float twice_texcoords, float twice_area, float cone_width, float cosine);
float texture_level(const TextureHeader& header);

}  // namespace coppice::twins
