#ifndef COPPICE_INTERFACE_REFINE_H
#define COPPICE_INTERFACE_REFINE_H
#include "trace.h"
INTERFACE_BEGIN

const uint SAMPLE_ADD_GROUP = 64;
const uint NOISE_SUM_GROUP = 64;
const uint NOISE_MARKS_GROUP = 64;
const uint NOISE_PIXELS_GROUP = 64;
const uint NOISE_SUM_RUN = 64;    // values that an invocation adds up
const float NOISE_DARK = 0.0001;  // added to squares of luminance: what is darker than 0.01 counts as that
const float NOISE_MOST = 65536.0;

// Of the luminance of a pixel's samples: by how much they are above the first one, and the squares of that,
// added up. So nothing is lost where all samples are nearly alike, and the sums are the same on every device.
struct LuminanceSums {
  float first, sum, squares;
};

INTERFACE_BUFFER(LuminanceSumsBuffer, LuminanceSums, 4)

// Adds a sample of each pixel to those before it.
struct SampleAddArgs {
  READS(Vec3Buffer) sample_radiance;  // pixel_count
  Vec3Buffer radiance;                // pixel_count; read unless this is sample 0
  LuminanceSumsBuffer luminance;      // the same
  UintBuffer sample_counts;           // out: sample_index + 1; may be null
  READS(UintBuffer) pixels;           // pixel_count: which of the last three; null: those from the first on
  uint pixel_count;
  uint sample_index;
};

// Sums of runs of NOISE_SUM_RUN values: of the squares of the relative errors of pixels or, where there is no
// luminance, of sums.
struct NoiseSumArgs {
  READS(LuminanceSumsBuffer) luminance;  // count, or null
  READS(FloatBuffer) values;             // count, or null
  READS(UintBuffer) sample_counts;       // of each pixel; null: all have `samples`
  FloatBuffer sums;                      // one a run
  uint count;
  uint samples;  // at least 2
};

// Which pixels have a larger error than is asked for.
struct NoiseMarksArgs {
  READS(LuminanceSumsBuffer) luminance;  // pixel_count
  READS(UintBuffer) sample_counts;       // pixel_count; at least 2
  UintBuffer marks;                      // out: 1 or 0
  uint pixel_count;
  uint least;  // the bits of a float: squares of relative errors beyond it are marked
};

struct NoisePixelsArgs {
  READS(UintBuffer) marks;   // pixel_count
  READS(UintBuffer) places;  // their prefix sums
  UintBuffer pixels;         // out: those that are marked, in their order
  UintBuffer active_count;   // out: their number
  uint pixel_count;
  uint padding;
};

struct SampleAddConstants {
  uint is_list;     // 0 where there are no pixels
  uint has_counts;  // 0 where there are no sample_counts
};

struct NoiseSumConstants {
  uint of_pixels;  // 0 where there is no luminance
  uint has_counts;
};

INTERFACE_END
#endif
