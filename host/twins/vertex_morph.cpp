#include "interface/vertex.h"

namespace coppice::twins {

void vertex_morph(const VertexMorphArgs& args) {
  for (uint i = 0; i < args.coordinate_count; ++i)
    args.vertices[i] = args.source[i] + args.offsets[i] * args.weight[0];
}

}  // namespace coppice::twins
