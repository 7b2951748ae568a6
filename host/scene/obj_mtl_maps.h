#pragma once

#include <string_view>

#include "scene/texture_map.h"

namespace coppice {

struct MtlMap {
  TextureMap map;           // without a folder; without a name where none stands behind the options
  bool has_unused = false;  // an option that would change the picture and is not read
};

// What stands behind map_Kd and the like: options, then the name of a file, which may hold blanks and be in
// quotes. Of the options -o, -s, -clamp, -bm and -imfchan count. What is no option of the format, or one
// without what belongs to it, begins the name.
MtlMap parse_mtl_map(std::string_view statement);

}  // namespace coppice
