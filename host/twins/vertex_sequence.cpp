#include "interface/vertex.h"

namespace coppice::twins {

void vertex_sequence(const VertexSequenceArgs& args) {
  const SequenceStep step = args.at[0];
  const std::size_t count = args.coordinate_count;
  for (std::size_t i = 0; i < count; ++i) {
    const float a = args.positions[step.frame * count + i];
    args.vertices[i] = step.part == 0 ? a : a + (args.positions[step.next_frame * count + i] - a) * step.part;
  }
}

}  // namespace coppice::twins
