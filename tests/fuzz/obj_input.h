#pragma once

#include <string>
#include <string_view>

namespace coppice {

// Reads `input` as an OBJ; after a line `===` in it comes the MTL text that every `mtllib` names, but for
// names that begin with `missing`. Returns what a reader must not do, empty where there is nothing to
// complain of: an index out of range, counts that do not fit, a camera or material that is not finite, a
// message that is not one line of printable text, any exception but InputError, or another result when it is
// read in small parts or by the parser of record alone.
std::string complaint_about_obj(std::string_view input);

}  // namespace coppice
