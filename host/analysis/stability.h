#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/judge_hits.h"
#include "analysis/ray_example.h"

namespace coppice {

// A choice of intersection tests.
struct IntersectionVariant {
  std::string_view triangle, box;  // as the command line names them
  std::uint32_t triangle_test, box_test;
};

// All four, fast first.
const std::vector<IntersectionVariant>& intersection_variants();

// What one kind of rays found with one variant.
struct RayResult {
  std::string_view kind;
  HitVerdicts verdicts{};
  std::uint64_t leaks = 0;             // misses of rays from inside of a closed mesh
  std::vector<RayExample> examples{};  // one of each kind of failure, the gravest first

  // Of the first example, on one line; empty where nothing failed.
  std::string example() const { return examples.empty() ? "" : described(examples.front()); }
};

struct VariantResult {
  const IntersectionVariant* variant;
  std::vector<RayResult> kinds;
  bool bits_equal = false;  // the device's hits are the twins'
  std::string error;        // that the trace ended with; then no ray is judged

  // Of the examples the first of each kind of failure.
  RayResult total() const;
};

struct StabilityCase {
  std::string scene;
  std::uint64_t seed = 1;
  std::uint64_t triangles = 0;
  std::uint32_t rounds = 0, rounds_bound = 0, depth = 0;
  std::string fault;             // of the device's tree; empty: valid
  std::string difference;        // first one between device and twins in the build; empty: bits equal
  bool same_as_builder = false;  // the independent builder's tree has the same bits
  std::vector<VariantResult> variants;

  // Whether the build is sound and the most accurate variant loses and invents no hit.
  bool passes() const;
};

// Sums over cases and seeds, by variant and kind of ray.
class KindSums {
 public:
  void add(const StabilityCase& one);
  const std::vector<std::vector<RayResult>>& sums() const { return sums_; }  // in the order of the variants

 private:
  std::vector<std::vector<RayResult>> sums_ =
      std::vector<std::vector<RayResult>>(intersection_variants().size());
};

// Rays from inside of a closed mesh that must all hit.
struct LeakCount {
  std::string mesh;
  double scale;
  const IntersectionVariant* variant;
  std::uint64_t rays = 0, leaks = 0;
  double seconds = 0;
  std::string example{};  // of a leak

  // Whether the most accurate variant leaks.
  bool fails() const;
};

}  // namespace coppice
