#pragma once

#include "interface/shade.h"

namespace coppice::twins {

// The material of a hit: of its triangle or, where materials are those of hits (texture_hits) and there is no
// index, of its ray.
template <class Args>
const SurfaceMaterial& material_of(const Args& args, uint ray, uint triangle) {
  return args.materials[args.material_index.value == 0 ? ray : args.material_index[triangle]];
}

}  // namespace coppice::twins
