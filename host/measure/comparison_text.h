#pragma once

#include <string>
#include <string_view>

namespace coppice {

// Names come from files and may hold anything. Each of these gives one line of valid UTF-8: control
// characters become blanks, bytes that are no UTF-8 the replacement character U+FFFD.

std::string one_line(std::string_view text);

// For a heading or a cell of a table: nothing in it is markup.
std::string markdown_text(std::string_view text);

// For the text of an element or an attribute in quotes of either kind.
std::string xml_text(std::string_view text);

}  // namespace coppice
