#ifndef COPPICE_INTERFACE_COPY_H
#define COPPICE_INTERFACE_COPY_H
#include "types.h"
#ifdef __cplusplus
#include <glm/vec4.hpp>
namespace coppice {
using glm::uvec4;
}
#endif
INTERFACE_BEGIN

const uint COPY_GROUP = 256;
const uint COPY_PER_INVOCATION = 4;  // quads of words: the most that is read or written at once
const uint COPY_TILE = COPY_GROUP * COPY_PER_INVOCATION;

INTERFACE_BUFFER(WordQuadBuffer, uvec4, 16)

struct CopyWordsArgs {
  READS(WordQuadBuffer) source;  // quad_count
  WordQuadBuffer target;         // quad_count
  uint quad_count;
  uint padding;
};

INTERFACE_END
#endif
