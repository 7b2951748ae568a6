#include "library/build_input.h"

#include "library/state.h"

namespace coppice {

BuildOptions to_build_options(const TreeOptions& options) {
  BuildOptions build;
  build.builder = options.builder;
  build.radius = options.radius;
  build.morton_bits = options.morton_bits;
  return build;
}

BuildInput to_build_input(const TriangleInput& input) {
  check_address(input.vertices, 4, input.count.maximum == 0, "vertices");
  if (input.vertex_stride < 12 || input.vertex_stride % 4 != 0)
    throw ArgumentError("vertex_stride: " + std::to_string(input.vertex_stride) +
                        " is no multiple of 4 of at least 12");
  if (input.index_type != VK_INDEX_TYPE_UINT16 && input.index_type != VK_INDEX_TYPE_UINT32)
    throw ArgumentError("index_type: neither VK_INDEX_TYPE_UINT16 nor VK_INDEX_TYPE_UINT32");
  const std::uint32_t index_bytes = input.index_type == VK_INDEX_TYPE_UINT16 ? 2 : 4;
  check_address(input.indices, index_bytes, true, "indices");
  check_address(input.transform, 4, true, "transform");
  VertexTriangles triangles;
  triangles.vertices = {input.vertices};
  triangles.indices = {input.indices};
  triangles.transform = {input.transform};
  triangles.vertex_count = input.vertex_count;
  triangles.vertex_stride = input.vertex_stride;
  triangles.first_vertex = input.first_vertex;
  triangles.index_bytes = index_bytes;
  return {triangles, {input.count.address}};
}

BuildInput to_build_input(const BoxInput& input) {
  check_address(input.boxes, 4, input.count.maximum == 0, "boxes");
  if (input.stride < sizeof(CoppiceBox) || input.stride % 4 != 0)
    throw ArgumentError("stride: " + std::to_string(input.stride) + " is no multiple of 4 of at least 24");
  return {GivenBoxes{{input.boxes}, input.stride}, {input.count.address}};
}

}  // namespace coppice
