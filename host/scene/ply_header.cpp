#include "scene/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

std::optional<PlyType> ply_type(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (word == names[i][0] || word == names[i][1]) return static_cast<PlyType>(i);
  }
  return std::nullopt;
}

std::vector<std::string_view> ply_words(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t", at);
    if (begin == line.npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return words;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  PlyHeader read() {
    if (next_line() != "ply") fail("no PLY file, expected 'ply' as the first line");
    bool has_format = false;
    for (;;) {
      if (header_.end >= text_.size()) fail("ends in the header, expected 'end_header'");
      const std::string_view line = next_line();
      const std::vector<std::string_view> words = ply_words(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        read_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else {
        fail("'" + printable(words[0]) + "', expected format, element, property, comment or end_header");
      }
    }
    if (!has_format) fail("no format, expected a line 'format ascii 1.0' or the like before end_header");
    check_sizes();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(std::max<std::size_t>(header_.lines, 1)) + ": " + what);
  }

  // Ended by LF, CR LF or CR.
  std::string_view next_line() {
    const std::size_t begin = header_.end, end = std::min(text_.find_first_of("\r\n", begin), text_.size());
    header_.end = std::min(end + 1, text_.size());
    if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') header_.end = end + 2;
    ++header_.lines;
    return text_.substr(begin, end - begin);
  }

  void read_format(const std::vector<std::string_view>& words) {
    const std::string_view format = words.size() == 3 ? words[1] : "";
    if (format == "ascii") {
      header_.format = PlyFormat::ascii;
    } else if (format == "binary_little_endian") {
      header_.format = PlyFormat::little_endian;
    } else if (format == "binary_big_endian") {
      header_.format = PlyFormat::big_endian;
    } else {
      fail("format of no known kind, expected ascii, binary_little_endian or binary_big_endian, and 1.0");
    }
  }

  void read_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    const auto count = words.size() == 3 ? words[2] : "";
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (count.empty() || error != std::errc{} || end != count.data() + count.size()) {
      fail("element without a count, expected 'element NAME COUNT'");
    }
    element.name = words[1];
    header_.elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("property before any element");
    PlyProperty property;
    property.is_list = words.size() > 1 && words[1] == "list";
    const std::size_t first = property.is_list ? 2 : 1;
    if (words.size() != (property.is_list ? 5 : 3))
      fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    for (std::size_t i = first; i + 1 < words.size(); ++i) {
      const auto type = ply_type(words[i]);
      if (!type)
        fail("type '" + printable(words[i]) +
             "', expected char, uchar, short, ushort, int, uint, float or double");
      (property.is_list && i == first ? property.count_type : property.type) = *type;
    }
    if (property.is_list && property.count_type >= PlyType::float32)
      fail("list whose count is no integer, expected uchar or the like");
    property.name = words.back();
    header_.elements.back().properties.push_back(std::move(property));
  }

  void check_sizes() const {
    const std::size_t room = text_.size() - header_.end;
    for (const PlyElement& element : header_.elements) {
      std::uint64_t least = 0;  // bytes of one
      for (const PlyProperty& property : element.properties) {
        least += header_.format == PlyFormat::ascii
                     ? 2
                     : ply_bytes(property.is_list ? property.count_type : property.type);
      }
      // The last line of an ASCII file may lack its end.
      if (least > 0 && element.count > (room + 1) / least) {
        fail("element " + printable(std::string_view(element.name)) + " " + std::to_string(element.count) +
             ", expected no more than the " + std::to_string(room) + " bytes behind the header can hold");
      }
    }
  }

  std::string_view text_;
  const std::string& name_;
  PlyHeader header_;
};

}  // namespace

std::size_t ply_bytes(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::float64:
      return 8;
    default:
      return 4;
  }
}

PlyHeader read_ply_header(std::string_view text, const std::string& name) {
  return HeaderReader(text, name).read();
}

}  // namespace coppice
