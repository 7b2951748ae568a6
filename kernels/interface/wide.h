// Wide tree: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
// 2017: eight children a node, their boxes in 8 bits a plane on a grid of the node's own.
#ifndef COPPICE_INTERFACE_WIDE_H
#define COPPICE_INTERFACE_WIDE_H
#include "types.h"
INTERFACE_BEGIN

const uint WIDE_CHILDREN = 8;
const uint WIDE_PLANE_WORDS = 12;
const uint WIDE_LEAF = 0x80000000u;   // in a child word: the rest is a triangle index; else it is a wide node
const uint WIDE_EMPTY = 0xffffffffu;  // no child

// Child c has six bytes of `planes` from byte 6 c on: min x, y, z, max x, y, z. A byte q of an axis means the plane
// origin + q * step, rounded as float arithmetic rounds it; the step is the power of two whose biased exponent is the
// axis' byte of `exponents` (x lowest). The box so decoded contains the child's box. An empty child is min 255, max 0.
struct WideNode {
  vec3 origin;
  uint exponents;
  uint planes[WIDE_PLANE_WORDS];
  uint child[WIDE_CHILDREN];
};

INTERFACE_BUFFER(WideNodeBuffer, WideNode, 16)

INTERFACE_END
#endif
