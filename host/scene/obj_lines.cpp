#include "scene/obj_lines.h"

#include <algorithm>

namespace coppice {
namespace {

std::size_t after_line_end(std::string_view text, std::size_t end) {
  std::size_t last = end;
  while (last < text.size() && text[last] == '\r') ++last;
  if (last < text.size() && text[last] == '\n') return last + 1;
  return std::min(end + 1, text.size());
}

void blank_out(std::string& text, std::size_t begin, std::size_t end) {
  std::fill(text.begin() + static_cast<std::ptrdiff_t>(begin),
            text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
}

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string_view without_padding(std::string_view text) {
  constexpr std::string_view padding("\0\r\n", 3);
  const std::size_t last = text.find_last_not_of(padding);
  const std::string_view end = text.substr(last == text.npos ? 0 : last + 1);
  return end.find('\0') == end.npos ? text : text.substr(0, text.size() - end.size());
}

StatementPlace join_statement(std::string& text, std::size_t begin) {
  if (text.compare(begin, 3, "\xEF\xBB\xBF") == 0) blank_out(text, begin, begin + 3);
  std::size_t end = begin, lines = 1;
  bool is_comment = false;
  while (true) {
    while (end < text.size() && text[end] != '\n' && text[end] != '\r') {
      if (text[end] == '#') is_comment = true;
      ++end;
    }
    std::size_t last = end;
    while (last > begin && is_blank(text[last - 1])) --last;
    if (is_comment || last == begin || text[last - 1] != '\\') break;
    const std::size_t next_line = after_line_end(text, end);
    blank_out(text, last - 1, next_line);
    end = next_line;
    if (end == text.size()) break;
    ++lines;
  }
  return {begin, end, after_line_end(text, end), lines};
}

}  // namespace coppice
