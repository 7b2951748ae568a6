// The parser of record of OBJ text: what may be unusual is checked here, and tinyobjloader reads the faces.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <sstream>

#include "scene/obj_lines.h"
#include "scene/obj_part.h"
#include "scene/printable.h"

namespace coppice {
namespace {

// The number nearest to a word: infinite where it is too large, NaN where the word is no number.
template <class Number>
Number parse_number(std::string_view word, Number (*parse_out_of_range)(const char*, char**)) {
  const char* begin = word.data();
  const char* const end = begin + word.size();
  if (begin != end && *begin == '+') ++begin;
  Number value = 0;
  const auto [parsed_end, error] = std::from_chars(begin, end, value);
  if (parsed_end != end || error == std::errc::invalid_argument) {
    return std::numeric_limits<Number>::quiet_NaN();
  }
  if (error != std::errc::result_out_of_range) return value;
  // from_chars does not tell too large from too small.
  return parse_out_of_range(std::string(begin, end).c_str(), nullptr);
}

constexpr std::array STATEMENTS =
    std::to_array<std::string_view>({"v", "vt", "vn", "vp", "f", "l", "p", "g", "o", "s", "usemtl", "mtllib",
                                     "cstype", "deg", "surf", "curv"});

// A # behind a point is none: so some compilers' programs write what is no number, 1.#QNAN.
std::size_t find_comment(std::string_view line) {
  std::size_t at = line.find('#');
  while (at != line.npos && at > 0 && line[at - 1] == '.') at = line.find('#', at + 1);
  return at;
}

class ObjChecker {
 public:
  ObjChecker(std::string& text, glm::dvec3 offset, ObjPart& part)
      : text_(text), offset_(offset), part_(part) {}

  // Leaves text that a parser that trusts its input may read: vertices without numbers and faces of at least
  // three indices that are numbers, but not 0.
  void check() {
    if (text_.find('\0') != text_.npos) {
      part_.is_binary = true;
      return;
    }
    for (std::size_t begin = 0; begin < text_.size();) {
      const StatementPlace statement = join_statement(text_, begin);
      line_ = part_.line_count + 1;
      part_.line_count += statement.lines;
      check_statement(statement.begin, statement.end);
      if (part_.error) {
        blank_out(statement.begin, text_.size());
        return;
      }
      begin = statement.next;
    }
  }

 private:
  void check_statement(std::size_t begin, std::size_t end) {
    Words words(std::string_view(text_).substr(begin, end - begin));
    const std::string_view keyword = words.next();
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "V" || keyword == "F") text_[offset_of(keyword)] += 'a' - 'A';
    if (!part_.recognised) {
      part_.recognised = std::find(STATEMENTS.begin(), STATEMENTS.end(), keyword) != STATEMENTS.end();
    }
    const std::string lower = keyword.size() == 6 ? lower_case(keyword) : "";
    // tinyobjloader overflows an int on exponents of ten digits, so it sees no numbers but indices.
    if (keyword == "v") {
      read_vertex(words);
      blank_out(offset_of(keyword) + 1, end);
    } else if (keyword == "vt" || keyword == "vn") {
      read_attribute(keyword == "vt", words);
      blank_out(begin, end);
    } else if (keyword == "f") {
      check_face(words, begin, end);
    } else {
      if (lower == "usemtl" || lower == "mtllib") read_material(lower, trim(words.rest()));
      if (keyword == "surf" || keyword == "curv" || keyword == "curv2") part_.free_form.add(line_);
      blank_out(begin, end);
    }
  }

  void read_material(std::string_view keyword, std::string_view name) {
    part_.recognised = true;
    if (name.empty()) return;
    if (keyword == "usemtl")
      part_.uses.push_back({face_count_, std::string(name), line_});
    else
      part_.libraries.push_back({std::string(name), line_});
  }

  std::size_t offset_of(std::string_view word) const {
    return static_cast<std::size_t>(word.data() - text_.data());
  }

  void blank_out(std::size_t begin, std::size_t end) {
    std::fill(text_.begin() + static_cast<std::ptrdiff_t>(begin),
              text_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }

  void read_vertex(Words words) {
    words = Words(words.rest().substr(0, find_comment(words.rest())));
    glm::vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      if (word.empty()) return fail("vertex with " + std::to_string(axis) + " coordinates, 3 are needed");
      position[axis] = parse_coordinate(word, offset_[axis]);
    }
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
      part_.non_finite.add(line_);
    }
    if (is_vertex_colour(words.rest())) part_.coloured.add(line_);
    part_.positions.push_back(position);
  }

  // Numbers that are missing are 0, what is no number is NaN.
  void read_attribute(bool is_texcoord, Words words) {
    words = Words(words.rest().substr(0, find_comment(words.rest())));
    glm::vec3 numbers{0};
    for (int axis = 0; axis < (is_texcoord ? 2 : 3); ++axis) {
      if (const std::string_view word = words.next(); !word.empty())
        numbers[axis] = parse_coordinate(word, 0);
    }
    if (is_texcoord)
      part_.texcoords.emplace_back(numbers);
    else
      part_.normals.push_back(numbers);
  }

  void check_face(Words words, std::size_t begin, std::size_t end) {
    const std::size_t comment = std::string_view(text_).substr(begin, end - begin).find('#');
    if (comment != std::string_view::npos) blank_out(begin + comment, end);
    std::size_t corner_count = 0;
    for (Words counted = words; !counted.next().empty();) ++corner_count;
    if (corner_count < 3) {
      part_.small_faces.add(line_);
      blank_out(begin, end);
      return;
    }
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (!check_index(word)) return;
    }
    if (corner_count > 3) part_.polygon_lines.push_back(static_cast<std::uint32_t>(line_));
    ++face_count_;
  }

  // `word` is i, i/j, i//k or i/j/k; i must be right, j and k are none where they are not. With another slash
  // tinyobjloader would take the rest for an index 0.
  bool check_index(std::string_view word) {
    std::string_view digits = word.substr(0, word.find('/'));
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::int32_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument ||
        std::count(word.begin(), word.end(), '/') > 2 || word.starts_with("+-")) {
      return fail("'" + printable(word) + "' is no vertex index"), false;
    }
    if (error == std::errc::result_out_of_range) {
      return fail("vertex index " + printable(digits) + " is out of range"), false;
    }
    if (index == 0) return fail("vertex index 0 is out of range: the first vertex is 1"), false;
    part_.note_index(index, line_);
    const std::size_t slash = std::min(word.find('/'), word.size()), second = word.find('/', slash + 1);
    const std::string_view normal = second == word.npos ? "" : word.substr(second + 1);
    const std::string_view texcoord = slash == word.size() ? "" : word.substr(slash + 1, second - slash - 1);
    part_.corner_texcoords.add(corner_count_, attribute_index(texcoord), part_.texcoords.size());
    part_.corner_normals.add(corner_count_, attribute_index(normal), part_.normals.size());
    ++corner_count_;
    return true;
  }

  // 0 for none.
  std::int32_t attribute_index(std::string_view word) {
    if (word.empty()) return 0;
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int32_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (end == word.data() + word.size() && error == std::errc{} && index != 0) return index;
    part_.odd_attributes.add(line_);
    return 0;
  }

  void fail(std::string what) { part_.error = {line_, std::move(what)}; }

  std::string& text_;
  const glm::dvec3 offset_;
  ObjPart& part_;
  std::size_t line_ = 0;  // of the statement's first line
  std::size_t face_count_ = 0, corner_count_ = 0;
};

// What tinyobjloader's callbacks add to.
struct Reading {
  ObjPart& part;
  std::size_t vertices_so_far = 0;

  void add_face(std::span<const tinyobj::index_t> corners) {
    for (const tinyobj::index_t& corner : corners) part.add_corner(corner.vertex_index, vertices_so_far);
    part.end_face();
  }
};

tinyobj::callback_t callbacks() {
  tinyobj::callback_t result;
  result.vertex_cb = [](void* user, auto...) { ++static_cast<Reading*>(user)->vertices_so_far; };
  result.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
    static_cast<Reading*>(user)->add_face({corners, static_cast<std::size_t>(count)});
  };
  return result;
}

}  // namespace

float parse_coordinate(std::string_view word, double offset) {
  if (offset == 0) return parse_number<float>(word, std::strtof);
  const double value = parse_number<double>(word, std::strtod) - offset;
  if (!(std::abs(value) > std::numeric_limits<float>::max())) return static_cast<float>(value);
  return std::copysign(std::numeric_limits<float>::infinity(), value < 0 ? -1.0f : 1.0f);
}

// By callbacks, not LoadObj: that one drops triangles of polygons that it cannot cut, takes quadratic time
// over large ones, and fails on lines and points with odd indices, which we have no use for.
ObjPart read_obj_part(std::string text, glm::dvec3 offset) {
  ObjPart part;
  ObjChecker(text, offset, part).check();
  if (part.is_binary) return part;
  Reading reading{.part = part};
  std::istringstream stream(std::move(text));
  tinyobj::LoadObjWithCallback(stream, callbacks(), &reading);
  return part;
}

}  // namespace coppice
