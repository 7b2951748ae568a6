#include "analysis/stability.h"

#include <algorithm>

#include "interface/trace.h"

namespace coppice {

const std::vector<IntersectionVariant>& intersection_variants() {
  static const std::vector<IntersectionVariant> variants = {
      {"fast", "fast", TRIANGLE_FAST, BOX_FAST},
      {"fast", "robust", TRIANGLE_FAST, BOX_ROBUST},
      {"watertight", "fast", TRIANGLE_WATERTIGHT, BOX_FAST},
      {"watertight", "robust", TRIANGLE_WATERTIGHT, BOX_ROBUST}};
  return variants;
}

RayResult VariantResult::total() const {
  RayResult sum{"all", {}};
  for (const RayResult& kind : kinds) {
    sum.verdicts += kind.verdicts;
    sum.leaks += kind.leaks;
  }
  for (const std::string_view failure : FAILURES) {
    for (const RayResult& kind : kinds) {
      const auto found = std::ranges::find(kind.examples, failure, &RayExample::failure);
      if (found == kind.examples.end()) continue;
      sum.examples.push_back(*found);
      break;
    }
  }
  return sum;
}

bool StabilityCase::passes() const {
  const bool built = fault.empty() && difference.empty() && same_as_builder && rounds <= rounds_bound;
  const RayResult accurate = variants.back().total();
  const bool bits = std::ranges::all_of(variants, &VariantResult::bits_equal);
  return built && bits && accurate.leaks == 0 && accurate.verdicts.missed == 0 &&
         accurate.verdicts.false_hits == 0;
}

void KindSums::add(const StabilityCase& one) {
  for (std::size_t v = 0; v < sums_.size(); ++v) {
    for (const RayResult& kind : one.variants[v].kinds) {
      auto sum = std::ranges::find(sums_[v], kind.kind, &RayResult::kind);
      if (sum == sums_[v].end()) sum = sums_[v].insert(sums_[v].end(), {kind.kind, {}});
      sum->verdicts += kind.verdicts;
      sum->leaks += kind.leaks;
    }
  }
}

bool LeakCount::fails() const { return variant == &intersection_variants().back() && leaks > 0; }

}  // namespace coppice
