#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coppice {

// The lines of OBJ and MTL files.

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }

// Without blanks at either end.
std::string_view trim(std::string_view text);

// ASCII letters in lower case, the other bytes as they are.
std::string lower_case(std::string_view text);

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

  // What follows the last word.
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// Without the zero bytes that some systems pad the end of a file with.
std::string_view without_padding(std::string_view text);

// One statement: its bytes without the line end, where the next begins, and the lines it takes.
struct StatementPlace {
  std::size_t begin, end, next, lines;
};

// The statement at `begin`, made one line: backslashes that continue it are blanked out in `text` with the
// line ends after them, and so is a byte order mark before it. LF, CR, CR LF and CR CR LF end a line. Blanks
// may stand between a backslash and the line end; one that ends the text continues nothing and goes too. In a
// comment, from any # on, a backslash is but a character, as at the end of a Windows path.
StatementPlace join_statement(std::string& text, std::size_t begin);

}  // namespace coppice
