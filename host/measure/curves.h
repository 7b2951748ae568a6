#pragma once

#include <string>
#include <vector>

namespace coppice {

struct Curve {
  std::string name;
  std::vector<double> values;  // one a place on the axis across; NaN: none
};

// Curves over the same places, from zero up.
struct CurvePanel {
  std::string unit;  // of the values, at the axis
  std::vector<Curve> curves;
};

// Panels below each other over one axis, whose places are first, first + 1, ...
std::string to_svg(const std::string& title, const std::string& across, double first,
                   const std::vector<CurvePanel>& panels);

}  // namespace coppice
