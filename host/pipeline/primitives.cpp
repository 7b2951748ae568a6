#include "pipeline/primitives.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "stages/divide_up.h"
#include "stages/stages.h"

namespace coppice {

namespace {

void check_multiple(const char* what, std::uint64_t value, std::uint64_t of) {
  if (value % of != 0)
    throw std::invalid_argument(std::string(what) + " " + std::to_string(value) + " is no multiple of " +
                                std::to_string(of));
}

void check_stride(const char* what, std::uint32_t stride, std::uint32_t least) {
  check_multiple(what, stride, 4);
  if (stride < least)
    throw std::invalid_argument(std::string(what) + " " + std::to_string(stride) + " is less than " +
                                std::to_string(least));
}

void check(const PackedTriangles&) {}

void check(const VertexTriangles& input) {
  check_multiple("address of vertices", input.vertices.value, 4);
  check_stride("stride of vertices", input.vertex_stride, 3 * sizeof(float));
  if (input.index_bytes != 2 && input.index_bytes != 4)
    throw std::invalid_argument("indices have 2 or 4 bytes, not " + std::to_string(input.index_bytes));
  check_multiple("address of indices", input.indices.value, input.index_bytes);
  check_multiple("address of a transform", input.transform.value, 4);
}

void check(const GivenBoxes& input) {
  check_multiple("address of boxes", input.boxes.value, 4);
  check_stride("stride of boxes", input.stride, sizeof(Aabb));
}

}  // namespace

PrimitiveSlots plan_primitives(Layout& layout, std::uint32_t count, PrimitiveKind kind) {
  PrimitiveSlots slots;
  slots.count = count;
  const std::uint32_t triangle_count = kind == PrimitiveKind::triangles ? count : 0;
  slots.triangles = layout.add<Triangle>("triangles", triangle_count, Memory::tree);
  slots.boxes = layout.add<Aabb>("boxes", count);
  slots.state = layout.add<BuildState>("state", 1, Memory::tree);
  return slots;
}

uvec3 counted_groups(std::uint32_t count, std::uint32_t size, UintBuffer count_at) {
  return {std::max(divide_up(count, size), count_at.value ? 1u : 0u), 1, 1};
}

void append_triangles(Chain& chain, const Slot<Triangle>& triangles, const VertexTriangles& input,
                      UintBuffer count_at) {
  check(input);
  const auto count = static_cast<std::uint32_t>(triangles.count);
  chain.run(stages::gather_triangles,
            {input.vertices, input.indices, input.transform, chain.at(triangles), count_at, count,
             input.vertex_count, input.vertex_stride, input.first_vertex, input.index_bytes, 0},
            groups_of(count, GATHER_TRIANGLES_TILE));
}

void append_primitives(Chain& chain, const PrimitiveSlots& slots, const BuildInput& input) {
  std::visit([](const auto& primitives) { check(primitives); }, input.primitives);
  check_multiple("address of a count", input.count_at.value, 4);
  const auto* const given = std::get_if<GivenBoxes>(&input.primitives);
  if (given ? slots.triangles.count > 0 : slots.triangles.count < slots.count)
    throw std::invalid_argument(given ? "boxes for a plan of triangles" : "triangles for a plan of boxes");
  const uvec3 groups = counted_groups(slots.count, PRIMITIVE_BOUNDS_TILE, input.count_at);
  if (given) {
    chain.run(stages::box_bounds,
              {given->boxes, chain.at(slots.boxes), chain.at(slots.state), input.count_at, slots.count,
               given->stride},
              groups);
    return;
  }
  if (const auto* const vertices = std::get_if<VertexTriangles>(&input.primitives))
    append_triangles(chain, {slots.triangles.place, slots.count}, *vertices, input.count_at);
  chain.run(stages::primitive_bounds,
            {chain.at(slots.triangles), chain.at(slots.boxes), chain.at(slots.state), input.count_at,
             slots.count, 0},
            groups);
}

}  // namespace coppice
