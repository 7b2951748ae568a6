#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/tree_hash.h"
#include "view/run_view.h"

namespace coppice {

namespace {

Json percentiles(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double part) {
    if (values.empty()) return 0.0;
    const auto place = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
    return values[std::clamp<std::size_t>(place, 1, values.size()) - 1];
  };
  return {{"p50", at(0.5)}, {"p95", at(0.95)}, {"p99", at(0.99)}, {"max", at(1)}};
}

}  // namespace

Json to_json(const ViewReport& report) {
  return {{"scene", report.scene},
          {"triangles", report.triangles},
          {"builder", report.builder},
          {"tree", report.walk},
          {"device", report.device},
          {"driver", report.driver},
          {"width", report.width},
          {"height", report.height},
          {"frames", report.frames},
          {"frame_ms", percentiles(report.frame_ms)},
          {"device_ms", percentiles(report.device_ms)},
          {"image_hash", hex16(report.image_hash)}};
}

}  // namespace coppice
