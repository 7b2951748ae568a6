#ifndef COPPICE_INTERFACE_TRACE_H
#define COPPICE_INTERFACE_TRACE_H
#include "wide.h"
INTERFACE_BEGIN

const uint CAMERA_RAYS_GROUP = 64;
const uint TRACE_GROUP = 64;
const uint TRACE_PACKET = 64;  // rays that trace_wide takes through the tree together
const uint TRACE_BLOCK = 128;  // rays of a subgroup of trace_wide_single
const uint BOUNCE_RAYS_GROUP = 64;

const uint TRACE_STACK_LIMIT = 256;    // most entries of a traversal stack
const uint BRUTE_FORCE_SLICE = 16384;  // triangles one dispatch tests, below old lavapipe's loop limit
const uint NO_TRIANGLE = 0xffffffffu;

// A word of flags a primitive. A ray sees a primitive where the masks of both have a bit in common.
const uint PRIMITIVE_MASK = 0xffu;           // of both; a ray's bits beyond them do not matter
const uint PRIMITIVE_NOT_OPAQUE = 0x100u;    // never ends a ray of an any hit
const uint PRIMITIVE_FLAGS_DEFAULT = 0xffu;  // where there are no words of flags

// Which tests a trace uses; both in the arguments and as specialization constants.
const uint TRIANGLE_FAST = 0;        // Moller and Trumbore 1997
const uint TRIANGLE_WATERTIGHT = 1;  // Woop, Benthin and Wald 2013
const uint BOX_FAST = 0;             // slabs as they come
const uint BOX_ROBUST = 1;           // slabs widened by the error bound, after Ize 2013

// A ray hits nothing with a NaN, an infinite origin or direction, an empty range (t_min > t_max), or a
// direction whose components are all zero or denormal. Components that are denormal or below 2^-64 of the
// largest count as 0.
struct Ray {
  vec3 origin;
  float t_min;
  vec3 direction;  // any length; t is in units of it
  float t_max;     // may be infinite
};

// Closest hit; of equally close triangles the one with the smallest index, whatever the order of traversal.
struct Hit {
  float t;        // t_max of the ray for a miss
  uint triangle;  // NO_TRIANGLE for a miss
  float u, v;     // barycentric coordinates of corners b and c
};

// A leaf whose box a ray meets.
struct BoxCandidate {
  uint primitive;
  float t_enter;  // where the ray enters the box, as widened by the robust test; at least t_min
};

// Rays of a picture come in strips of so many rows (the last may have fewer), from left to right, in each
// column of a strip from top to bottom: 64 rays that follow each other are a square of pixels.
const uint FILM_STRIP = 8;

// Pinhole camera: a ray through film coordinates (x, y) in [0, width) x [0, height) has the direction
// corner + x * right + y * down, of which t counts depths. Through a point (a, b) of the unit disk of a thin
// lens it starts at position + aside, aside = a * lens_right + b * lens_down, and goes where the pinhole's
// ray is in focus: in the direction of that ray - aside * per_focus.
struct Film {
  vec3 position;
  uint width;
  vec3 corner;
  uint height;
  vec3 right;
  uint samples;
  vec3 down;
  uint is_sequence;  // 0: samples are a set of so many; 1: the first of a sequence, whatever their number
  vec3 lens_right;   // of the length of the lens's radius, as is lens_down
  float per_focus;   // 1 by the depth that is in focus
  vec3 lens_down;
  uint padding;
};

// Dimensions of lib/sampler.glsl, each one use in a picture.
const uint SAMPLE_LENS = 0x10000u;
const uint SAMPLE_OCCLUSION = 0x10001u;

// Counted on the device; 64-bit sums as (low, high) words. Steps are pairs of binary nodes that rays visit,
// or wide nodes that they, or their packets, visit.
struct TraceCounters {
  uvec2 rays, hits, steps;
  uint padding0, padding1;
};

INTERFACE_BUFFER(RayBuffer, Ray, 16)
INTERFACE_BUFFER(HitBuffer, Hit, 16)
INTERFACE_BUFFER(BoxCandidateBuffer, BoxCandidate, 8)
INTERFACE_BUFFER(FilmBuffer, Film, 16)
INTERFACE_BUFFER(TraceCountersBuffer, TraceCounters, 16)
INTERFACE_BUFFER(Vec3Buffer, vec3, 4)

struct CameraRaysArgs {
  READS(FilmBuffer) film;
  RayBuffer rays;            // ray_count
  HitBuffer hits;            // ray_count, set to misses
  READS(UintBuffer) pixels;  // ray_count: rays of the picture; null: those from first_ray on
  uint first_ray;            // of the picture
  uint ray_count;
  uint sample_index;
  uint has_lens;  // as in CameraRaysConstants
};

// Rays of a trace: `ray_count`, or where there is a `count_at` what its word says, if that is less; no others
// are looked at. A ray's mask is `ray_mask` or, where there are `ray_masks`, what it has in common with its
// word there; the closest hit is the closest one on a primitive that the ray sees, opaque or not.
struct TraceClosestArgs {
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  HitBuffer hits;  // read and improved
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;  // one a primitive; null: PRIMITIVE_FLAGS_DEFAULT
  READS(UintBuffer) ray_masks;        // one a ray; may be null
  READS(UintBuffer) count_at;         // may be null
  UintBuffer ray_steps;               // one a ray, where the constant counts_rays says so; else null
  uint ray_count;
  uint ray_mask;
  uint stack_entries;  // a tree of greater height is refused (ERROR_TREE_TOO_DEEP)
  uint triangle_test;  // TRIANGLE_
  uint box_test;       // BOX_
  uint padding;
};

// Watertight and robust; the hits of these tests do not depend on the order of traversal.
struct TraceWideArgs {
  READS(WideNodeBuffer) wide_nodes;
  READS(WideCountsBuffer) wide_counts;  // no nodes: nothing is hit
  READS(NodeBuffer) nodes;              // the binary tree; only its root's box is read
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  HitBuffer hits;  // read and improved
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;  // this and what follows as in TraceClosestArgs
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  UintBuffer ray_steps;
  uint ray_count;
  uint ray_mask;
};

// Any hit: for each ray whether it hits some opaque primitive that it sees, with t in [t_min, t_max]. A
// primitive that is not opaque ends no ray, as if it were not there: who has alpha masks takes closest hits.
// With the watertight and the robust test the answer does not depend on the order of visits; it is then,
// without flags and masks, whether the closest hit is one. A tree higher than the stack hits nothing.
struct TraceAnyArgs {
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  UintBuffer any_hits;  // out, a word a ray: 1 or 0
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;  // this and what follows as in TraceClosestArgs
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  uint ray_count;
  uint ray_mask;
  uint stack_entries;
  uint triangle_test;
  uint box_test;
  uint padding;
};

// The same through a wide tree, watertight and robust.
struct TraceWideAnyArgs {
  READS(WideNodeBuffer) wide_nodes;
  READS(WideCountsBuffer) wide_counts;
  READS(NodeBuffer) nodes;
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  UintBuffer any_hits;
  TraceCountersBuffer counters;
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  uint ray_count;
  uint ray_mask;
};

// The leaves that a ray sees and whose boxes it meets with t in [t_min, t_max], by the robust test: of each
// ray as many as there are, and the `capacity` nearest ones in the order of t_enter, of equal ones the
// smaller primitive first. Neither depends on the order of visits, nor on the internal nodes. An entry beyond
// the range of float is none. A leaf each, where a primitive has several.
struct TraceCandidatesArgs {
  READS(NodeBuffer) nodes;
  READS(RayBuffer) rays;
  BoxCandidateBuffer candidates;  // out, `capacity` a ray; those beyond the count are not written
  UintBuffer candidate_counts;    // out, a word a ray; may be more than the capacity
  TraceCountersBuffer counters;   // a hit is a ray with candidates
  BuildStateBuffer state;
  READS(UintBuffer) primitive_flags;  // this and what follows as in TraceClosestArgs
  READS(UintBuffer) ray_masks;
  READS(UintBuffer) count_at;
  uint ray_count;
  uint ray_mask;
  uint stack_entries;
  uint capacity;
};

// No hit yet for each ray.
struct TraceMissesArgs {
  READS(RayBuffer) rays;
  HitBuffer hits;              // out
  READS(UintBuffer) count_at;  // as in TraceClosestArgs
  uint ray_count;
  uint padding;
};

struct TraceBruteForceArgs {
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;
  HitBuffer hits;  // read and improved
  TraceCountersBuffer counters;
  uint ray_count;
  uint first_triangle;
  uint triangle_count;  // of this slice
  uint last_slice;      // 1: count rays and hits
  uint triangle_test;   // TRIANGLE_
  uint padding;
};

struct BounceRaysArgs {
  READS(TriangleBuffer) triangles;
  READS(RayBuffer) rays;   // ray_count
  READS(HitBuffer) hits;   // ray_count
  RayBuffer bounced;       // ray_count; hits nothing where nothing was hit
  HitBuffer bounced_hits;  // ray_count, set to misses
  uint ray_count;
  uint seed;
};

// Specialization constants; what is an argument, too, has the same value there.
struct TraceClosestConstants {
  uint max_turns;        // of the loop; a tree has fewer pairs than triangles, so this binds only on a driver
                         // that ends long loops by itself
  uint visits_per_turn;  // pairs
  uint stack_entries;
  uint triangle_test;
  uint box_test;
  uint masked;       // 0: without looking every ray sees every primitive
  uint counts_rays;  // 1: the steps of each ray are kept, too; not for any hits
};

struct TraceWideConstants {
  uint max_turns;
  uint masked;
  uint counts_rays;
};

struct TraceCandidatesConstants {
  uint max_turns;  // of all loops
  uint stack_entries;
  uint masked;
};

struct TraceBruteForceConstants {
  uint triangle_test;
};

struct CameraRaysConstants {
  uint is_list;   // 0 where there are no pixels
  uint has_lens;  // 0: a pinhole
};

INTERFACE_END
#endif
