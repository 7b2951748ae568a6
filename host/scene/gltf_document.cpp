#include "scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "gltf_schema.h"
#include "scene/input_error.h"
#include "scene/json_check.h"
#include "scene/printable.h"

namespace coppice {
namespace {

using nlohmann::json;

// Extensions that a file may require: their effect is here, or on how a surface looks only.
bool is_known_extension(std::string_view extension) {
  constexpr std::array<std::string_view, 6> known = {"KHR_mesh_quantization", "KHR_texture_transform",
                                                     "KHR_texture_basisu",    "EXT_texture_webp",
                                                     "KHR_lights_punctual",   "KHR_xmp_json_ld"};
  return extension.starts_with("KHR_materials_") ||
         std::find(known.begin(), known.end(), extension) != known.end();
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return word;
}

struct Chunks {
  std::string_view json, binary;
  bool has_binary = false;
};

Chunks chunks_of(std::string_view text, const std::string& name) {
  if (!text.starts_with("glTF")) return {text, {}, false};
  const auto fail = [&](const std::string& what) { throw InputError(name + ": " + what); };
  if (text.size() < 20) fail("ends in the header of a GLB");
  if (word_at(text, 4) != 2) fail("GLB version " + std::to_string(word_at(text, 4)) + ", expected 2");
  const std::size_t length = word_at(text, 8);
  if (length > text.size()) {
    fail("GLB of " + std::to_string(length) + " bytes, but the file has " + std::to_string(text.size()));
  }
  Chunks chunks;
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= length; ++chunk) {
    const std::size_t size = word_at(text, at);
    const std::uint32_t type = word_at(text, at + 4);
    if (size > length - at - 8) {
      fail("GLB chunk " + std::to_string(chunk) + " of " + std::to_string(size) +
           " bytes reaches beyond the file");
    }
    const std::string_view content = text.substr(at + 8, size);
    if (chunk == 0 && type != 0x4e4f534a) fail("GLB whose first chunk is not JSON");
    if (chunk == 0) chunks.json = content;
    if (chunk == 1 && type == 0x004e4942) {
      chunks.binary = content;
      chunks.has_binary = true;
    }
    at += 8 + size;
  }
  if (chunks.json.empty()) fail("GLB without a JSON chunk");
  return chunks;
}

// -1 for what is no character of base64.
std::array<signed char, 256> base64_values() {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<signed char, 256> values;
  values.fill(-1);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    values[static_cast<unsigned char>(letters[i])] = static_cast<signed char>(i);
  }
  return values;
}

// tinygltf's decoder ends without a word at a wrong character, and takes a search for each.
std::string decode_base64(const GltfDocument& document, const std::string& pointer, std::string_view text) {
  static const std::array<signed char, 256> values = base64_values();
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = values[static_cast<unsigned char>(c)];
    if (value < 0) {
      document.fail(pointer, "character '" + printable(std::string_view(&c, 1)) + "', expected base64");
    }
    word = word << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(word >> bits);
    }
  }
  return bytes;
}

std::string bytes_of_uri(const GltfDocument& document, const std::string& pointer, const std::string& uri,
                         const FindBytes& find) {
  if (!uri.starts_with("data:")) {
    const std::string decoded = percent_decoded(uri);
    if (decoded.find('\0') != decoded.npos) document.fail(pointer, "holds a zero byte, expected a path");
    try {
      return find(decoded);
    } catch (const InputError& error) {
      document.fail(pointer, error.what());
    }
  }
  return document.bytes_of_data_uri(uri, pointer);
}

// The contents of all buffers, each exactly as long as it says.
std::vector<std::string> buffers_of(GltfDocument& document, const Chunks& chunks, const FindBytes& find) {
  std::vector<std::string> contents;
  if (!document.json.contains("buffers")) return contents;
  const json& buffers = document.json["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string pointer = "/buffers/" + std::to_string(i);
    const json& buffer = buffers[i];
    const auto length = buffer["byteLength"].get<std::size_t>();
    std::string content;
    if (buffer.contains("uri")) {
      content = bytes_of_uri(document, pointer + "/uri", buffer["uri"].get_ref<const std::string&>(), find);
    } else if (i == 0 && chunks.has_binary) {
      content = chunks.binary;
    } else {
      document.fail(pointer, "key \"uri\" is missing, and there is no binary chunk for it");
    }
    if (content.size() < length) {
      document.fail(pointer + "/byteLength", std::to_string(length) + ", expected at most the " +
                                                 std::to_string(content.size()) + " bytes that there are");
    }
    content.resize(length);
    document.bytes += length;
    contents.push_back(std::move(content));
  }
  return contents;
}

// What tinygltf is to read: "buffer" plus an index instead of files, and no images, whose offsets it does not
// check. Cameras and materials are read from the JSON: it refuses what is not used of them.
json reduced(const json& document) {
  json result = json::object();
  for (const char* const key :
       {"asset", "scene", "scenes", "nodes", "meshes", "skins", "animations", "bufferViews", "accessors"}) {
    if (document.contains(key)) result[key] = document[key];
  }
  result["buffers"] = json::array();
  if (!document.contains("buffers")) return result;
  for (const json& buffer : document["buffers"]) {
    result["buffers"].push_back(
        {{"byteLength", buffer["byteLength"]}, {"uri", "buffer" + std::to_string(result["buffers"].size())}});
  }
  return result;
}

bool exists_always(const std::string& path, void*) { return path.starts_with("buffer"); }
std::string as_it_is(const std::string& path, void*) { return path; }
bool give_buffer(std::vector<unsigned char>* out, std::string*, const std::string& path, void* contents) {
  std::string& content = (*static_cast<std::vector<std::string>*>(contents))[std::stoul(path.substr(6))];
  out->assign(content.begin(), content.end());
  content = {};
  return true;
}

void check_header(const GltfDocument& document) {
  const json& asset = document.json["asset"];
  for (const char* const key : {"version", "minVersion"}) {
    const std::string version = asset.value(key, "2.0");
    if (!version.starts_with("2.") || (std::string_view(key) == "minVersion" && version != "2.0")) {
      document.fail("/asset/" + std::string(key), shortened(asset[key]) + ", expected \"2.0\"");
    }
  }
  const json required = document.json.value("extensionsRequired", json::array());
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string extension = required[i].get<std::string>();
    if (!is_known_extension(extension)) {
      document.fail("/extensionsRequired/" + std::to_string(i),
                    "extension '" + printable(std::string_view(extension)) +
                        "' is not read, expected a file without it");
    }
  }
}

// tinygltf refuses these without saying where.
void check_indices(const GltfDocument& document) {
  if (!document.json.contains("meshes")) return;
  const json& meshes = document.json["meshes"];
  const std::size_t count = document.json.contains("accessors") ? document.json["accessors"].size() : 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const json& primitives = meshes[i]["primitives"];
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      if (!primitives[k].contains("indices")) continue;
      const int index = primitives[k]["indices"].get<int>();
      document.check_index("/meshes/" + std::to_string(i) + "/primitives/" + std::to_string(k) + "/indices",
                           index, count, "accessors");
      const json& accessor = document.json["accessors"][static_cast<std::size_t>(index)];
      if (!accessor.contains("bufferView")) {
        document.fail("/accessors/" + std::to_string(index),
                      "key \"bufferView\" is missing, indices need one");
      }
      document.check_index(
          "/accessors/" + std::to_string(index) + "/bufferView", accessor["bufferView"].get<int>(),
          document.json.contains("bufferViews") ? document.json["bufferViews"].size() : 0, "buffer views");
    }
  }
}

}  // namespace

std::string percent_decoded(std::string_view uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      result += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

std::string GltfDocument::bytes_of_data_uri(const std::string& uri, const std::string& pointer) const {
  const std::size_t comma = uri.find(',');
  const std::string_view head = std::string_view(uri).substr(0, comma);
  if (comma == uri.npos || !head.ends_with(";base64")) {
    fail(pointer, "'" + printable(head) + "', expected data:...;base64,...");
  }
  return decode_base64(*this, pointer, std::string_view(uri).substr(comma + 1));
}

std::string GltfDocument::bytes_of_view(int view, const std::string& user) const {
  check_index(user, view, model.bufferViews.size(), "buffer views");
  const tinygltf::BufferView& of = model.bufferViews[static_cast<std::size_t>(view)];
  const std::string pointer = "/bufferViews/" + std::to_string(view);
  check_index(pointer + "/buffer", of.buffer, model.buffers.size(), "buffers");
  const std::vector<unsigned char>& all = model.buffers[static_cast<std::size_t>(of.buffer)].data;
  if (of.byteOffset > all.size() || of.byteLength > all.size() - of.byteOffset) {
    fail(pointer, "bytes " + std::to_string(of.byteOffset) + " to " +
                      std::to_string(of.byteOffset + of.byteLength) +
                      ", expected an end within the buffer's " + std::to_string(all.size()));
  }
  return {reinterpret_cast<const char*>(all.data()) + of.byteOffset, of.byteLength};
}

void GltfDocument::fail(const std::string& pointer, const std::string& what) const {
  fail_at(name, pointer, what);
}

void GltfDocument::check_index(const std::string& pointer, int index, std::size_t count,
                               const char* of) const {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return;
  fail(pointer, std::to_string(index) + ", expected an index below " + std::to_string(count) +
                    ", the number of " + of);
}

GltfDocument read_gltf_document(std::string_view text, const std::string& name, const FindBytes& find) {
  GltfDocument document;
  document.name = name;
  document.bytes = text.size();
  const Chunks chunks = chunks_of(text, name);
  document.json = parse_json(chunks.json, name);
  check_schema(document.json, GLTF_SCHEMA, name);
  check_header(document);
  check_indices(document);
  std::vector<std::string> contents = buffers_of(document, chunks, find);
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({&exists_always, &as_it_is, &give_buffer, nullptr, &contents});
  const std::string small = reduced(document.json).dump();
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&document.model, &error, &warning, small.data(),
                                  static_cast<unsigned>(small.size()), "")) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw InputError(name + ": " + printable(std::string_view(error)));
  }
  return document;
}

}  // namespace coppice
