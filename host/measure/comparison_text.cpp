#include "measure/comparison_text.h"

#include <cstdint>

namespace coppice {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

// How many bytes of `text` are its first character; 0 where they are no UTF-8. Overlong forms, surrogates and
// what lies above U+10FFFF are none, and neither are U+FFFE and U+FFFF, which XML forbids.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t count = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || count > text.size()) return 0;
  std::uint32_t code = byte(0) & (0xFFu >> (count + 1));
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code < least[count] || code > 0x10FFFF || surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : count;
}

bool is_letter_or_digit(std::string_view text, std::size_t i) {
  if (i >= text.size()) return false;
  const char c = text[i];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

const char* entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return nullptr;
  }
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t count = character_bytes(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (count == 0) {
      line += replacement;
    } else if (first < 0x20 || first == 0x7F) {
      line += ' ';
    } else {
      line += text.substr(0, count);
    }
    text.remove_prefix(count == 0 ? 1 : count);
  }
  return line;
}

std::string markdown_text(std::string_view text) {
  const std::string line = one_line(text);
  const bool several_tildes = line.find('~') != line.rfind('~');  // one alone strikes nothing out
  std::string escaped;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '&' || c == '<' || c == '>') {
      escaped += entity(c);
      continue;
    }
    // Between letters an underscore is no markup, and names are full of them.
    const bool inside = i > 0 && is_letter_or_digit(line, i - 1) && is_letter_or_digit(line, i + 1);
    if (std::string_view("\\`*|[]").find(c) != std::string_view::npos || (c == '_' && !inside) ||
        (c == '~' && several_tildes))
      escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string xml_text(std::string_view text) {
  std::string escaped;
  for (const char c : one_line(text)) {
    if (const char* const name = entity(c)) {
      escaped += name;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace coppice
