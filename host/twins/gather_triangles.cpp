#include <bit>
#include <cstring>
#include <optional>

#include "interface/gather.h"
#include "twins/device_count.h"
#include "twins/finite.h"

namespace coppice::twins {

namespace {

template <class T>
T read_at(std::uint64_t address) {
  T value;
  std::memcpy(&value, reinterpret_cast<const void*>(address), sizeof value);
  return value;
}

// None if it is out of range.
std::optional<std::uint64_t> vertex_of(const GatherTrianglesArgs& args, std::uint64_t corner) {
  std::uint64_t index = corner;
  if (args.indices.value) {
    const std::uint64_t at = args.indices.value + corner * args.index_bytes;
    index = args.index_bytes == 2 ? read_at<std::uint16_t>(at) : read_at<std::uint32_t>(at);
  }
  index += args.first_vertex;
  if (index >= args.vertex_count) return std::nullopt;
  return index;
}

vec3 transformed(std::uint64_t rows, vec3 position) {
  vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    float sum = 0;
    for (int column = 0; column < 4; ++column) {
      const float by = flushed(read_at<float>(rows + 16 * axis + 4 * column));
      const float term = column == 3 ? by : flushed(by * position[column]);
      sum = column == 0 ? term : flushed(sum + term);
    }
    result[axis] = sum;
  }
  return result;
}

std::optional<vec3> corner_of(const GatherTrianglesArgs& args, std::uint64_t corner) {
  const auto vertex = vertex_of(args, corner);
  if (!vertex) return std::nullopt;
  vec3 position = read_at<vec3>(args.vertices.value + *vertex * args.vertex_stride);
  for (int axis = 0; axis < 3; ++axis) position[axis] = flushed(position[axis]);
  if (args.transform.value) position = transformed(args.transform.value, position);
  if (!all_finite(position)) return std::nullopt;
  return position;
}

}  // namespace

void gather_triangles(const GatherTrianglesArgs& args) {
  const vec3 inactive(std::bit_cast<float>(GATHERED_INACTIVE));
  const uint count = counted(args.count_at, args.triangle_count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto a = corner_of(args, 3 * i), b = corner_of(args, 3 * i + 1), c = corner_of(args, 3 * i + 2);
    const bool active = a && b && c;
    args.triangles[i] = active ? Triangle{*a, *b, *c} : Triangle{inactive, inactive, inactive};
  }
}

}  // namespace coppice::twins
