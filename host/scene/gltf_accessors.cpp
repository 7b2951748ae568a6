#include "scene/gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "scene/printable.h"

namespace coppice {
namespace {

std::string accessor_pointer(int accessor) { return "/accessors/" + std::to_string(accessor); }

const char* type_name(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    case TINYGLTF_TYPE_VEC4:
      return "VEC4";
    case TINYGLTF_TYPE_MAT2:
      return "MAT2";
    case TINYGLTF_TYPE_MAT3:
      return "MAT3";
    default:
      return "MAT4";
  }
}

// An element of type C in memory, as T.
template <class T, class C>
T converted(const unsigned char* at, bool normalized) {
  C value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_same_v<T, float> && std::is_integral_v<C>) {
    if (normalized) {
      const float part = static_cast<float>(value) / static_cast<float>(std::numeric_limits<C>::max());
      return std::max(part, -1.0f);
    }
  }
  return static_cast<T>(value);
}

template <class T, class C, class Elements>
void read_as(const Elements& from, std::vector<T>& to, const std::vector<std::uint32_t>* places) {
  const auto width = static_cast<std::size_t>(from.components);
  if (std::is_same_v<T, C> && !places && from.stride == width * sizeof(C)) {
    std::memcpy(to.data(), from.data, from.count * from.stride);
    return;
  }
  for (std::size_t i = 0; i < from.count; ++i) {
    T* const target = to.data() + (places ? (*places)[i] : i) * width;
    const unsigned char* const source = from.data + i * from.stride;
    for (std::size_t c = 0; c < width; ++c) {
      target[c] = converted<T, C>(source + c * sizeof(C), from.normalized);
    }
  }
}

// At `places` where they are given, else one after the other.
template <class T, class Elements>
void read_elements(const Elements& from, std::vector<T>& to, const std::vector<std::uint32_t>* places) {
  switch (from.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return read_as<T, std::int8_t>(from, to, places);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return read_as<T, std::uint8_t>(from, to, places);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return read_as<T, std::int16_t>(from, to, places);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read_as<T, std::uint16_t>(from, to, places);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return read_as<T, std::uint32_t>(from, to, places);
    default:
      if constexpr (std::is_same_v<T, float>) read_as<T, float>(from, to, places);
  }
}

}  // namespace

GltfAccessors::Elements GltfAccessors::in_view(const std::string& pointer, int view, std::size_t offset,
                                               Elements elements) const {
  const tinygltf::Model& model = document_.model;
  document_.check_index(pointer + "/bufferView", view, model.bufferViews.size(), "buffer views");
  const tinygltf::BufferView& buffer_view = model.bufferViews[static_cast<std::size_t>(view)];
  const std::string view_pointer = "/bufferViews/" + std::to_string(view);
  document_.check_index(view_pointer + "/buffer", buffer_view.buffer, model.buffers.size(), "buffers");
  const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(buffer_view.buffer)].data;
  const std::size_t begin = buffer_view.byteOffset, length = buffer_view.byteLength;
  if (begin > bytes.size() || length > bytes.size() - begin) {
    document_.fail(view_pointer, "bytes " + std::to_string(begin) + " to " + std::to_string(begin + length) +
                                     ", expected an end within the buffer's " + std::to_string(bytes.size()));
  }
  const auto component_bytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(elements.component_type)));
  const std::size_t element_bytes = component_bytes * static_cast<std::size_t>(elements.components);
  elements.stride = buffer_view.byteStride == 0 ? element_bytes : buffer_view.byteStride;
  if (elements.stride < element_bytes) {
    document_.fail(view_pointer + "/byteStride",
                   std::to_string(elements.stride) + ", expected at least the " +
                       std::to_string(element_bytes) + " bytes of an element of " + pointer);
  }
  // No overflow: the bounds come from the schema, and a count beyond the bytes ends here.
  const std::size_t room = offset <= length ? length - offset : 0;
  const std::size_t most = room < element_bytes ? 0 : (room - element_bytes) / elements.stride + 1;
  if (elements.count > most) {
    document_.fail(pointer + "/count", std::to_string(elements.count) + ", expected at most " +
                                           std::to_string(most) + ", which the " + std::to_string(length) +
                                           " bytes of " + view_pointer + " hold from offset " +
                                           std::to_string(offset));
  }
  elements.data = bytes.data() + begin + offset;
  return elements;
}

std::size_t GltfAccessors::count(int accessor, const std::string& user) const {
  document_.check_index(user, accessor, document_.model.accessors.size(), "accessors");
  return document_.model.accessors[static_cast<std::size_t>(accessor)].count;
}

GltfAccessors::Elements GltfAccessors::elements_of(int accessor, const char* type,
                                                   const std::string& user) const {
  document_.check_index(user, accessor, document_.model.accessors.size(), "accessors");
  const tinygltf::Accessor& from = document_.model.accessors[static_cast<std::size_t>(accessor)];
  const std::string pointer = accessor_pointer(accessor);
  if (type_name(from.type) != std::string_view(type)) {
    document_.fail(pointer + "/type",
                   std::string("\"") + type_name(from.type) + "\", expected \"" + type + "\" for " + user);
  }
  Elements elements;
  elements.count = from.count;
  elements.component_type = from.componentType;
  elements.components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type));
  elements.normalized = from.normalized;
  if (from.bufferView >= 0) return in_view(pointer, from.bufferView, from.byteOffset, elements);
  if (from.count > document_.bytes) {
    document_.fail(pointer + "/count",
                   std::to_string(from.count) +
                       ", expected no more elements without a buffer view than the file has "
                       "bytes (" +
                       std::to_string(document_.bytes) + ")");
  }
  return elements;
}

template <class T>
std::vector<T> GltfAccessors::read(int accessor, const char* type, const std::string& user) const {
  const Elements elements = elements_of(accessor, type, user);
  std::vector<T> result(elements.count * static_cast<std::size_t>(elements.components));
  if (elements.data) read_elements<T>(elements, result, nullptr);
  const tinygltf::Accessor& from = document_.model.accessors[static_cast<std::size_t>(accessor)];
  if (!from.sparse.isSparse) return result;

  const std::string pointer = accessor_pointer(accessor) + "/sparse";
  Elements places;
  places.count = static_cast<std::size_t>(from.sparse.count);
  places.component_type = from.sparse.indices.componentType;
  places.components = 1;
  if (places.count > elements.count) {
    document_.fail(pointer + "/count", std::to_string(places.count) + ", expected at most the accessor's " +
                                           std::to_string(elements.count));
  }
  places = in_view(pointer + "/indices", from.sparse.indices.bufferView,
                   static_cast<std::size_t>(from.sparse.indices.byteOffset), places);
  std::vector<std::uint32_t> indices(places.count);
  read_elements<std::uint32_t>(places, indices, nullptr);
  for (const std::uint32_t index : indices) {
    if (index >= elements.count) {
      document_.fail(pointer + "/indices", "index " + std::to_string(index) + ", expected one below " +
                                               std::to_string(elements.count));
    }
  }
  Elements values = elements;
  values.count = places.count;
  values = in_view(pointer + "/values", from.sparse.values.bufferView,
                   static_cast<std::size_t>(from.sparse.values.byteOffset), values);
  read_elements<T>(values, result, &indices);
  return result;
}

std::vector<float> GltfAccessors::floats(int accessor, const char* type, const std::string& user) const {
  return read<float>(accessor, type, user);
}

std::vector<std::uint32_t> GltfAccessors::integers(int accessor, const char* type, int most_bytes,
                                                   const std::string& user) const {
  document_.check_index(user, accessor, document_.model.accessors.size(), "accessors");
  const int component_type = document_.model.accessors[static_cast<std::size_t>(accessor)].componentType;
  const bool is_unsigned = component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_unsigned ||
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)) > most_bytes) {
    document_.fail(accessor_pointer(accessor) + "/componentType",
                   std::to_string(component_type) + ", expected " +
                       (most_bytes == 4 ? "5121, 5123 or 5125" : "5121 or 5123") + " for " + user);
  }
  return read<std::uint32_t>(accessor, type, user);
}

}  // namespace coppice
