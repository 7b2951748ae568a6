#include "scene/load_ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "scene/face_digest.h"
#include "scene/input_error.h"
#include "scene/obj_file.h"
#include "scene/obj_offset.h"
#include "scene/ply_header.h"
#include "scene/printable.h"
#include "scene/scene_notes.h"
#include "scene/triangulate.h"

namespace coppice {
namespace {

template <class T>
double number_in(const char* bytes, bool is_swapped) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (is_swapped) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

// Numbers of the data, one after the other. A number of any type fits into double.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view text, const PlyHeader& header, const std::string& name)
      : text_(text), at_(header.end), line_(header.lines + 1), format_(header.format), name_(name) {}

  // Each element begins on a line of its own.
  void begin_element(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
    if (format_ != PlyFormat::ascii) return;
    while (at_ < text_.size()) {
      skip_blanks();
      if (at_ == text_.size() || !is_line_end()) break;
      skip_line_end();
    }
  }
  void end_element() {
    if (format_ != PlyFormat::ascii) return;
    skip_blanks();
    if (at_ < text_.size() && !is_line_end()) fail("more numbers in the line than properties");
  }

  double next(PlyType type) { return format_ == PlyFormat::ascii ? next_word() : next_bytes(type); }

  std::size_t left() const { return text_.size() - at_; }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string element =
        printable(std::string_view(element_->name)) + " " + std::to_string(index_) + ": ";
    throw InputError(name_ + (format_ == PlyFormat::ascii ? ":" + std::to_string(line_) : "") + ": " +
                     element + what);
  }

 private:
  bool is_line_end() const { return text_[at_] == '\n' || text_[at_] == '\r'; }
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  void skip_line_end() {
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    ++line_;
  }

  double next_word() {
    skip_blanks();
    if (at_ == text_.size()) fail("the file ends, expected another number");
    if (is_line_end()) fail("the line ends, expected another number");
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
    std::string_view word = text_.substr(at_, end - at_);
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [parsed, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range) {
      value = std::numeric_limits<double>::quiet_NaN();
    } else if (error != std::errc{} || parsed != word.data() + word.size()) {
      fail("'" + printable(word) + "', expected a number");
    }
    at_ = end;
    return value;
  }

  double next_bytes(PlyType type) {
    const std::size_t size = ply_bytes(type);
    if (size > text_.size() - at_) fail("the file ends, expected " + std::to_string(size) + " more bytes");
    const char* const bytes = text_.data() + at_;
    at_ += size;
    const bool swapped =
        (format_ == PlyFormat::little_endian) != (std::endian::native == std::endian::little);
    switch (type) {
      case PlyType::int8:
        return number_in<std::int8_t>(bytes, swapped);
      case PlyType::uint8:
        return number_in<std::uint8_t>(bytes, swapped);
      case PlyType::int16:
        return number_in<std::int16_t>(bytes, swapped);
      case PlyType::uint16:
        return number_in<std::uint16_t>(bytes, swapped);
      case PlyType::int32:
        return number_in<std::int32_t>(bytes, swapped);
      case PlyType::uint32:
        return number_in<std::uint32_t>(bytes, swapped);
      case PlyType::float32:
        return number_in<float>(bytes, swapped);
      default:
        return number_in<double>(bytes, swapped);
    }
  }

  std::string_view text_;
  std::size_t at_, line_;
  PlyFormat format_;
  const std::string& name_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
};

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& name)
      : header_(read_ply_header(text, name)), numbers_(text, header_, name), name_(name), notes_(name) {}

  Scene read(glm::dvec3 offset) {
    offset_ = offset;
    find_vertices();
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        numbers_.begin_element(element, i);
        read_element(element);
        numbers_.end_element();
      }
    }
    cut_polygons();
    scene_.offset = offset;
    scene_.material_index.assign(scene_.indices.size(), 0);
    if (scene_.indices.empty()) notes_.add("", "no faces: nothing to draw");
    scene_.warnings = notes_.lines();
    return std::move(scene_);
  }

 private:
  // What the element "vertex" has, checked before any number is read.
  void find_vertices() {
    bool has[3] = {};
    for (const PlyElement& element : header_.elements) {
      if (element.name != "vertex") continue;
      if (vertex_count_ > 0) throw InputError(name_ + ": two elements 'vertex', expected one");
      vertex_count_ = element.count;
      for (const PlyProperty& property : element.properties) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          has[axis] |= !property.is_list && property.name == std::string(1, static_cast<char>('x' + axis));
        }
        if (property.name == "red" || property.name == "diffuse_red")
          notes_.add("", "vertex colours are not used");
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!has[axis])
          throw InputError(name_ + ": element vertex has no property '" + static_cast<char>('x' + axis) +
                           "'");
      }
    }
    if (vertex_count_ > UINT32_MAX) throw InputError(name_ + ": more than 4294967295 vertices");
  }

  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    const bool is_strip = element.name == "tristrips";
    glm::dvec3 position{0};
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        const double value = numbers_.next(property.type);
        if (is_vertex && property.name.size() == 1 && property.name >= "x" && property.name <= "z") {
          position[property.name[0] - 'x'] = value;
        }
        continue;
      }
      const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
      read_list(property);
      if (!is_corners) continue;
      if (is_face) add_face();
      if (is_strip) add_strip();
    }
    if (is_vertex) scene_.positions.emplace_back(position - offset_);
  }

  void read_list(const PlyProperty& property) {
    const double count = numbers_.next(property.count_type);
    if (!(count >= 0) || count != std::floor(count))
      numbers_.fail("list of " + std::to_string(count) + ", expected a count of at least 0");
    if (count > static_cast<double>(numbers_.left()))
      numbers_.fail("list of " + std::to_string(count) + " is longer than the file");
    list_.clear();
    for (double i = 0; i < count; ++i) list_.push_back(numbers_.next(property.type));
  }

  std::uint32_t vertex_of(double value) const {
    if (value >= 0 && value < static_cast<double>(vertex_count_) && value == std::floor(value)) {
      return static_cast<std::uint32_t>(value);
    }
    std::string text = std::to_string(value);
    if (value == std::floor(value)) text.resize(text.find('.'));
    numbers_.fail("vertex " + text + ", expected one below " + std::to_string(vertex_count_));
  }

  void add_face() {
    if (list_.size() < 3) {
      notes_.add("", "faces with fewer than three corners are left out");
      return;
    }
    for (const double value : list_) corners_.push_back(vertex_of(value));
    ends_.push_back(corners_.size());
  }

  // -1 begins another strip.
  void add_strip() {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) {
        begin = i + 1;
        continue;
      }
      vertex_of(list_[i]);
      if (i < begin + 2) continue;
      const bool is_odd = (i - begin) % 2 == 1;
      corners_.push_back(vertex_of(list_[i - 2]));
      corners_.push_back(vertex_of(list_[is_odd ? i : i - 1]));
      corners_.push_back(vertex_of(list_[is_odd ? i - 1 : i]));
      ends_.push_back(corners_.size());
    }
  }

  void cut_polygons() {
    std::size_t begin = 0, face = 0;
    FaceDigest digest;
    for (const std::size_t end : ends_) {
      const std::span<const std::uint32_t> polygon(corners_.data() + begin, end - begin);
      digest.add(face++, polygon);
      if (polygon.size() == 3) {
        scene_.indices.emplace_back(polygon[0], polygon[1], polygon[2]);
      } else if (!triangulate(scene_.positions, polygon, scene_.indices)) {
        notes_.add("", "polygons with edges that cross are cut as well as can be");
      }
      begin = end;
    }
    scene_.face_digest = digest.value();
  }

  PlyHeader header_;
  PlyNumbers numbers_;
  const std::string& name_;
  SceneNotes notes_;
  glm::dvec3 offset_{0};
  std::uint64_t vertex_count_ = 0;
  std::vector<double> list_;
  std::vector<std::uint32_t> corners_;  // of all polygons
  std::vector<std::size_t> ends_;       // of each of them
  Scene scene_;
};

}  // namespace

Scene parse_ply(std::string_view text, const std::string& name) {
  glm::dvec3 offset{0};
  for (int reread = 0;; ++reread) {
    Scene scene = PlyReader(text, name).read(offset);
    const glm::dvec3 more = reread < 2 ? find_offset(scene) : glm::dvec3{0};
    if (more == glm::dvec3{0}) {
      if (offset != glm::dvec3{0}) scene.warnings.push_back(name + ": " + describe_offset(offset));
      return scene;
    }
    offset += more;
  }
}

Scene load_ply(const std::filesystem::path& path) {
  const ObjFile file = read_obj_file(path);
  Scene scene = parse_ply(file.text(), printable(path));
  scene.name = printable(path.stem());
  return scene;
}

}  // namespace coppice
