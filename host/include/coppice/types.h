/* What lies in the memory that Coppice writes and reads: C and C++. The formats are described in
   docs/tree_format.md; those of a version do not change. */
#ifndef COPPICE_TYPES_H
#define COPPICE_TYPES_H

#include <stdint.h>

#define COPPICE_VERSION_MAJOR 0
#define COPPICE_VERSION_MINOR 2
#define COPPICE_VERSION_PATCH 0

/* Before what a shared library shows. */
#ifdef COPPICE_SHARED
#define COPPICE_API __attribute__((visibility("default")))
#else
#define COPPICE_API
#endif

/* Of the trees, rays and hits below. */
#define COPPICE_FORMAT_VERSION 1

/* Of every address and offset of memory that is given to the library as a MemoryRange. */
#define COPPICE_MEMORY_ALIGNMENT 256

/* A triangle by its corners. */
typedef struct CoppiceTriangle {
  float a[3], b[3], c[3];
} CoppiceTriangle;

typedef struct CoppiceBox {
  float box_min[3], box_max[3];
} CoppiceBox;

/* Of the binary tree. Root at 0; the children of an internal node are neighbours. */
typedef struct CoppiceNode {
  float box_min[3];
  uint32_t child; /* leaf: primitive; internal node: its first child, the second follows it */
  float box_max[3];
  uint32_t height; /* 0 for a leaf, else 1 + the larger height of the children */
} CoppiceNode;

#define COPPICE_WIDE_LEAF 0x80000000u  /* in a child word: the rest is a primitive; else a wide node */
#define COPPICE_WIDE_EMPTY 0xffffffffu /* no child */

/* Of the wide tree, root at 0: after Ylitie, Karras and Laine 2017. Child c has the bytes 6 c to 6 c + 5 of
   `planes`: min x, y, z, max x, y, z. A byte q of an axis is the plane origin + q * step, and the step is the
   power of two with the axis' byte of `exponents` (x lowest) as biased exponent. */
typedef struct CoppiceWideNode {
  float origin[3];
  uint32_t exponents;
  uint8_t planes[48];
  uint32_t child[8];
} CoppiceWideNode;

/* A ray hits nothing with a NaN, an infinite origin or direction, t_min > t_max, or a zero direction. */
typedef struct CoppiceRay {
  float origin[3];
  float t_min;
  float direction[3]; /* any length; t is in units of it */
  float t_max;        /* may be infinite */
} CoppiceRay;

#define COPPICE_NO_PRIMITIVE 0xffffffffu

/* Of equally close triangles the one with the smallest index. */
typedef struct CoppiceHit {
  float t;            /* t_max of the ray for a miss */
  uint32_t primitive; /* COPPICE_NO_PRIMITIVE for a miss */
  float u, v;         /* barycentric coordinates of corners b and c */
} CoppiceHit;

/* A primitive whose box a ray meets. */
typedef struct CoppiceCandidate {
  uint32_t primitive;
  float t_enter; /* where the ray enters the box; at least t_min */
} CoppiceCandidate;

/* In a word of flags of a primitive, beside its mask in bits 0 to 7: it never ends a ray of cmd_trace_any. */
#define COPPICE_PRIMITIVE_NOT_OPAQUE 0x100u

/* What a build says of itself, at TreeAddresses::state. */
typedef struct CoppiceTreeState {
  uint32_t bounds[3];
  uint32_t active_count; /* primitives in the tree: all finite ones; 0: no tree */
  uint32_t bounds_more[3];
  uint32_t round_count; /* PLOC rounds it took */
  uint32_t error_word; /* the flag word: bits below; 0: well. After a build with any of them there is no tree,
                          after WIDE_TOO_DEEP no wide one; traces add theirs */
  uint32_t
      primitive_count; /* that the build was asked for, larger than its maximum with COPPICE_ERROR_COUNT */
  uint32_t reserved[2];
} CoppiceTreeState;

/* What a refit says, at TreeAddresses::refit_state. */
typedef struct CoppiceRefitState {
  /* Triangles that are finite now, and were not when the tree was built: they are in no leaf, so no ray finds
     them. Above 0 the tree is to be built anew. */
  uint32_t appeared_count;
  uint32_t reserved;
  /* After cmd_tree_cost: the SAH cost is area_sum / root_area, with costs of 1. */
  float area_sum, root_area;
} CoppiceRefitState;

/* box_min of a node of a refitted tree that has no finite triangle, on all axes; box_max is its negative. No
   ray hits it, and it is no part of another box. */
#define COPPICE_NOTHING_BOX 3.402823466e38f

#define COPPICE_BATCH_MAX_PRIMITIVES 512

/* The primitives of one tree of a batch. */
typedef struct CoppiceRange {
  uint32_t first, count;
} CoppiceRange;

typedef struct CoppiceBatchTree {
  uint32_t active_count; /* primitives in the tree; 0: no tree */
  uint32_t round_count;
  uint32_t error_word;
  uint32_t reserved;
} CoppiceBatchTree;

#define COPPICE_ERROR_SORT_LOOKBACK 1u /* a tile of a sort waited in vain for those before it */
#define COPPICE_ERROR_PLOC_LOOKBACK 2u /* the same in a build */
#define COPPICE_ERROR_PLOC_ROUNDS 4u   /* rounds did not end within their bound */
#define COPPICE_ERROR_TREE_TOO_DEEP 8u
#define COPPICE_ERROR_TRACE_STEPS 16u /* a ray needs more steps than this driver's loops may take */
#define COPPICE_ERROR_SCAN_LOOKBACK 32u
#define COPPICE_ERROR_WIDE_TOO_DEEP 64u
#define COPPICE_ERROR_BATCH_RANGE 256u /* a range of a batch is too large or beyond the primitives */
#define COPPICE_ERROR_COUNT 128u       /* a count on the device is larger than its maximum */
#define COPPICE_ERROR_RAY_COUNT 512u   /* the same of rays: set in the state of their tree */
#define COPPICE_ERROR_REFIT_TOO_DEEP 1024u

#endif
