// The fast reader of plain parts. It gives up at the first thing that is not plain; the parser of record then
// says what it is.
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "scene/obj_lines.h"
#include "scene/obj_part.h"

namespace coppice {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool ends_word(char c) { return is_blank(c) || c == '\n' || c == '\r'; }

class PlainReader {
 public:
  PlainReader(std::string_view text, glm::dvec3 offset, ObjPart& part)
      : at_(text.data()), end_(at_ + text.size()), offset_(offset), part_(part) {}

  // Whether all was plain.
  bool read() {
    while (at_ != end_) {
      ++part_.line_count;
      if (!read_line()) return false;
    }
    return true;
  }

 private:
  bool read_line() {
    skip_blanks();
    if (at_line_end()) return end_line();
    const auto left = static_cast<std::size_t>(end_ - at_);
    const char first = *at_, second = left > 1 ? at_[1] : '\n', third = left > 2 ? at_[2] : '\n';
    if (first == '#') return skip_comment();
    if (first == 'v' && is_blank(second)) return ++at_, part_.recognised = true, read_vertex();
    if (first == 'f' && is_blank(second)) return ++at_, part_.recognised = true, read_face();
    if (first == 'v' && second == 't' && ends_word(third)) return at_ += 2, read_texcoord();
    if (first == 'v' && second == 'n' && ends_word(third)) return at_ += 2, read_normal();
    if ((first == 'g' || first == 'o' || first == 's') && ends_word(second)) return read_over();
    return read_material(std::string_view(at_, left));
  }

  // Of the keyword on, which is not empty.
  bool read_over() {
    part_.recognised = true;
    std::string_view ignored;
    return take_line(ignored);
  }

  bool read_material(std::string_view rest) {
    const bool is_use = rest.starts_with("usemtl");
    if ((!is_use && !rest.starts_with("mtllib")) || rest.size() == 6 || !is_blank(rest[6])) return false;
    part_.recognised = true;
    at_ += 6;
    std::string_view name;
    if (!take_line(name)) return false;
    name = trim(name);
    if (name.empty()) return true;
    if (is_use)
      part_.uses.push_back({part_.face_ends.size(), std::string(name), part_.line_count});
    else
      part_.libraries.push_back({std::string(name), part_.line_count});
    return true;
  }

  bool read_vertex() {
    glm::vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      if (!read_coordinate(offset_[axis], position[axis])) return false;
    }
    part_.positions.push_back(position);
    skip_blanks();
    if (at_line_end()) return end_line();
    if (*at_ == '#') return skip_comment();
    std::string_view rest;
    if (!take_line(rest)) return false;
    if (is_vertex_colour(rest)) part_.coloured.add(part_.line_count);
    return true;
  }

  // One number at least; of a third one nothing.
  bool read_texcoord() {
    part_.recognised = true;
    glm::vec2& texcoord = part_.texcoords.emplace_back(0.0f);
    skip_blanks();
    if (!read_number(texcoord.x)) return false;
    skip_blanks();
    if (!at_line_end() && *at_ != '#' && !read_number(texcoord.y)) return false;
    std::string_view ignored;
    return take_line(ignored);
  }

  bool read_normal() {
    part_.recognised = true;
    glm::vec3& normal = part_.normals.emplace_back(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      if (!read_coordinate(0, normal[axis])) return false;
    }
    std::string_view ignored;
    return take_line(ignored);
  }

  bool read_coordinate(double offset, float& result) {
    skip_blanks();
    if (offset != 0) {
      double value = 0;
      if (!read_number(value)) return false;
      value -= offset;
      if (!(std::abs(value) <= std::numeric_limits<float>::max())) return false;
      result = static_cast<float>(value);
      return true;
    }
    return read_number(result);
  }

  template <class Number>
  bool read_number(Number& number) {
    const auto [parsed_end, error] = std::from_chars(at_, end_, number);
    if (error != std::errc{} || !std::isfinite(number)) return false;
    at_ = parsed_end;
    return at_line_end() || is_blank(*at_);
  }

  bool read_face() {
    const std::size_t first_corner = part_.corners.size();
    while (true) {
      skip_blanks();
      if (at_line_end() || *at_ == '#') break;
      if (!read_corner()) return false;
    }
    const std::size_t count = part_.corners.size() - first_corner;
    if (count < 3) return false;
    if (count > 3) part_.polygon_lines.push_back(static_cast<std::uint32_t>(part_.line_count));
    part_.end_face();
    return at_line_end() ? end_line() : skip_comment();
  }

  // i, i/j, i//k or i/j/k.
  bool read_corner() {
    const std::int32_t index = read_index();
    if (index == 0) return false;
    std::int32_t texcoord = 0, normal = 0;
    if (at_ != end_ && *at_ == '/') {
      has_attributes_ = true;
      ++at_;
      if (!read_attribute_index(texcoord)) return false;
      if (at_ != end_ && *at_ == '/' && (++at_, !read_attribute_index(normal))) return false;
    }
    if (!(at_line_end() || is_blank(*at_))) return false;
    if (has_attributes_) {
      const std::size_t corner = part_.corners.size();
      part_.corner_texcoords.add(corner, texcoord, part_.texcoords.size());
      part_.corner_normals.add(corner, normal, part_.normals.size());
    }
    part_.note_index(index, part_.line_count);
    part_.add_corner(index, part_.positions.size());
    return true;
  }

  // 0 for what is no number, is 0, or may not fit.
  std::int32_t read_index() {
    const bool is_negative = at_ != end_ && *at_ == '-';
    if (is_negative) ++at_;
    const char* const digits = at_;
    std::int32_t index = 0;
    for (; at_ != end_ && is_digit(*at_); ++at_) {
      if (at_ - digits == 9) return 0;
      index = index * 10 + (*at_ - '0');
    }
    return is_negative ? -index : index;
  }

  // Behind a slash; 0 where nothing stands there.
  bool read_attribute_index(std::int32_t& index) {
    if (at_line_end() || is_blank(*at_) || *at_ == '/') return true;
    index = read_index();
    return index != 0;
  }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r'; }

  // A CR stands only before an LF, see read_plain_obj_part.
  bool end_line() {
    if (at_ != end_ && *at_ == '\r') ++at_;
    if (at_ != end_) ++at_;
    return true;
  }

  const char* find_line_end() const {
    const void* const found = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
    return found ? static_cast<const char*>(found) : end_;
  }

  bool skip_comment() {
    at_ = find_line_end();
    return end_line();
  }

  // The rest of the line; false if it is continued.
  bool take_line(std::string_view& line) {
    const char* const line_end = find_line_end();
    line = {at_, static_cast<std::size_t>(line_end - at_)};
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = line_end;
    return !trim(line).ends_with('\\') && end_line();
  }

  const char* at_;
  const char* const end_;
  const glm::dvec3 offset_;
  ObjPart& part_;
  bool has_attributes_ = false;  // any corner so far may have some
};

// Whether there is no zero byte, and no CR but before an LF.
bool has_plain_bytes(std::string_view text) {
  if (std::memchr(text.data(), '\0', text.size())) return false;
  for (std::size_t at = 0; (at = text.find('\r', at)) != text.npos; ++at) {
    if (at + 1 == text.size() || text[at + 1] != '\n') return false;
  }
  return true;
}

}  // namespace

bool is_vertex_colour(std::string_view rest) {
  Words words(rest.substr(0, rest.find('#')));
  std::size_t count = 0;
  while (count < 3 && !words.next().empty()) ++count;
  return count == 3;
}

std::optional<ObjPart> read_plain_obj_part(std::string_view text, glm::dvec3 offset) {
  if (!has_plain_bytes(text)) return std::nullopt;
  std::optional<ObjPart> part(std::in_place);
  part->positions.reserve(text.size() / 64);
  part->corners.reserve(text.size() / 16);
  part->face_ends.reserve(text.size() / 48);
  if (!PlainReader(text, offset, *part).read()) return std::nullopt;
  return part;
}

}  // namespace coppice
