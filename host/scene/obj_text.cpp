#include "scene/obj_text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

// The blank-separated words of a line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  // The next word, empty at the end of the line.
  std::string_view next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

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
  // from_chars does not tell too large from too small; strtof does, and stops at the blank that ends the
  // word.
  return error == std::errc::result_out_of_range ? parse_out_of_range(begin, nullptr) : value;
}

// The float nearest to a word, less `offset`.
float parse_coordinate(std::string_view word, double offset) {
  if (offset == 0) return parse_number<float>(word, std::strtof);
  const double value = parse_number<double>(word, std::strtod) - offset;
  if (!(std::abs(value) > std::numeric_limits<float>::max())) return static_cast<float>(value);
  return std::copysign(std::numeric_limits<float>::infinity(), value < 0 ? -1.0f : 1.0f);
}

constexpr std::array STATEMENTS =
    std::to_array<std::string_view>({"v", "vt", "vn", "vp", "f", "l", "p", "g", "o", "s", "usemtl", "mtllib",
                                     "cstype", "deg", "surf", "curv"});

class ObjChecker {
 public:
  ObjChecker(std::string name, ObjText& obj, glm::dvec3 offset)
      : name_(std::move(name)), obj_(obj), offset_(offset) {}

  void check() {
    std::string& text = obj_.text;
    if (text.find('\0') != std::string::npos) throw InputError(name_ + ": a binary file, not an OBJ file");
    if (text.starts_with("\xEF\xBB\xBF")) std::fill_n(text.begin(), 3, ' ');  // byte order mark

    for (std::size_t begin = 0; begin < text.size();) {
      ++line_number_;
      lines_in_statement_ = 1;
      const std::size_t end = find_line_end(begin);
      check_line(begin, end);
      // CR LF ends one line, as LF and a lone CR do.
      begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
      line_number_ += lines_in_statement_ - 1;
    }
    finish();
  }

 private:
  // The end of the line at `begin`. A backslash before it continues the line, unless that is a comment, which
  // may well end in a Windows path: both are blanked out.
  std::size_t find_line_end(std::size_t begin) {
    std::string& text = obj_.text;
    std::size_t end = begin;
    const bool is_comment = text[begin] == '#';
    while (true) {
      while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
      if (end == text.size() || end == begin || text[end - 1] != '\\' || is_comment) return end;
      const std::size_t next_line = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
      blank_out(end - 1, next_line);
      end = next_line;
      ++lines_in_statement_;
    }
  }

  void check_line(std::size_t begin, std::size_t end) {
    Words words(std::string_view(obj_.text).substr(begin, end - begin));
    const std::string_view keyword = words.next();
    if (keyword.empty() || keyword[0] == '#') return;
    if (!recognised_) {
      recognised_ = std::find(STATEMENTS.begin(), STATEMENTS.end(), keyword) != STATEMENTS.end();
    }
    // tinyobjloader overflows an int on exponents of ten digits, so it sees no numbers but indices.
    if (keyword == "v") {
      read_vertex(words);
      blank_out(offset_of(keyword) + 1, end);
    } else if (keyword == "vn" || keyword == "vt") {
      blank_out(begin, end);
    } else if (keyword == "f") {
      check_face(words, end);
    }
  }

  std::size_t offset_of(std::string_view word) const {
    return static_cast<std::size_t>(word.data() - obj_.text.data());
  }

  void blank_out(std::size_t begin, std::size_t end) {
    std::fill(obj_.text.begin() + static_cast<std::ptrdiff_t>(begin),
              obj_.text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }

  void read_vertex(Words& words) {
    glm::vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      if (word.empty()) fail("vertex with " + std::to_string(axis) + " coordinates, 3 are needed");
      position[axis] = parse_coordinate(word, offset_[axis]);
    }
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z)) {
      if (non_finite_count_++ == 0) first_non_finite_line_ = line_number_;
    }
    obj_.positions.push_back(position);
  }

  void check_face(Words& words, std::size_t line_end) {
    std::size_t vertex_count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word[0] == '#') {
        blank_out(offset_of(word), line_end);
        break;
      }
      check_index(word);
      ++vertex_count;
    }
    if (vertex_count < 3) {
      fail("face with " + std::to_string(vertex_count) + (vertex_count == 1 ? " vertex" : " vertices") +
           ", at least 3 are needed");
    }
    ++face_count_;
  }

  // `word` is i, i/j, i//k or i/j/k; of these only i is looked at, for normals and texture coordinates are
  // not used. With another slash tinyobjloader would take the rest for an index 0.
  void check_index(std::string_view word) {
    const std::string_view digits = word.substr(0, word.find('/'));
    if (std::count(word.begin(), word.end(), '/') > 2) fail("'" + printable(word) + "' is no vertex index");
    std::int32_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
      fail("'" + printable(word) + "' is no vertex index");
    }
    if (error == std::errc::result_out_of_range)
      fail("vertex index " + printable(digits) + " is out of range");
    if (index == 0) fail("vertex index 0 is out of range: the first vertex is 1");

    const auto so_far = static_cast<std::int64_t>(obj_.positions.size());
    if (index < 0 && -std::int64_t{index} > so_far) {
      fail("vertex index " + std::to_string(index) + " is out of range: there are " + std::to_string(so_far) +
           " vertices before it");
    }
    // A vertex may follow the face that names it, so an index too large is only known at the end.
    if (index > so_far && index > greatest_forward_index_) {
      greatest_forward_index_ = index;
      greatest_forward_line_ = line_number_;
    }
  }

  void finish() {
    if (!recognised_) throw InputError(name_ + ": not an OBJ file: no statement of the format in it");
    const std::size_t vertex_count = obj_.positions.size();
    if (greatest_forward_index_ > static_cast<std::int64_t>(vertex_count)) {
      line_number_ = greatest_forward_line_;
      fail("vertex index " + std::to_string(greatest_forward_index_) + " is out of range: the file has " +
           std::to_string(vertex_count) + (vertex_count == 1 ? " vertex" : " vertices"));
    }
    if (face_count_ == 0) obj_.warnings.push_back(name_ + ": no faces");
    if (non_finite_count_ > 0) {
      obj_.warnings.push_back(name_ + ": " + std::to_string(non_finite_count_) +
                              (non_finite_count_ == 1 ? " vertex" : " vertices") +
                              " with a coordinate that is no finite number, first in line " +
                              std::to_string(first_non_finite_line_));
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line_number_) + ": " + what);
  }

  std::string name_;
  ObjText& obj_;
  const glm::dvec3 offset_;
  std::size_t line_number_ = 0;         // of the first line of the statement, from 1
  std::size_t lines_in_statement_ = 1;  // more where lines are continued
  bool recognised_ = false;             // whether any statement was one of the format's
  std::size_t face_count_ = 0;
  std::size_t non_finite_count_ = 0;
  std::size_t first_non_finite_line_ = 0;
  std::int64_t greatest_forward_index_ = 0;
  std::size_t greatest_forward_line_ = 0;
};

}  // namespace

std::string read_obj_file(const std::filesystem::path& path) {
  const std::string name = printable(path);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(name + ": is a directory, not an OBJ file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": not a regular file");

  const auto size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw InputError(name + ": cannot open: " + std::strerror(errno));
  if (size == 0) throw InputError(name + ": empty file");
  std::string text(size, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(size))) throw InputError(name + ": cannot read");
  return text;
}

ObjText check_obj_text(std::string text, const std::string& name, glm::dvec3 offset) {
  ObjText obj;
  obj.text = std::move(text);
  ObjChecker(name, obj, offset).check();
  return obj;
}

}  // namespace coppice
