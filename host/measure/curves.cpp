#include "measure/curves.h"

#include <algorithm>
#include <cmath>

#include "measure/comparison_text.h"
#include "measure/table.h"

namespace coppice {

namespace {

constexpr double curves_width = 960, panel_height = 300, curves_margin = 60, panel_gap = 40;
constexpr const char* curve_colours[] = {"#3b6fb6", "#c0504d", "#5a9e4b", "#8064a2", "#d08a2e", "#3aa6a6"};

// 1, 2 or 5 times a power of ten: about eight of them reach `greatest`.
double grid_step(double greatest) {
  const double rough = greatest / 8, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (times * power >= rough) return times * power;
  }
  return 10 * power;
}

struct PanelPlace {
  double top, greatest, first, count;

  double x(double place) const {
    return curves_margin + (place - first) / std::max(count - 1, 1.0) * (curves_width - 2 * curves_margin);
  }
  double y(double value) const { return top + panel_height * (1 - value / greatest); }
};

std::string grid_of(const PanelPlace& place, const CurvePanel& panel) {
  std::string svg;
  const double step = grid_step(place.greatest);
  for (double value = 0; value <= place.greatest * 1.0001; value += step) {
    svg += format(
        "<path d='M%.1f %.1fH%.1f' stroke='#ddd'/><text x='%.1f' y='%.1f' text-anchor='end'>%g</text>\n",
        curves_margin, place.y(value), curves_width - curves_margin, curves_margin - 6, place.y(value) + 4,
        value);
  }
  return svg + format("<text transform='translate(16 %.1f) rotate(-90)' text-anchor='middle'>%s</text>\n",
                      place.top + panel_height / 2, xml_text(panel.unit).c_str());
}

std::string line_of(const PanelPlace& place, const Curve& curve, const char* colour) {
  std::string path;
  bool drawing = false;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    if (!std::isfinite(curve.values[i])) {
      drawing = false;
      continue;
    }
    path += format("%c%.1f %.1f", drawing ? 'L' : 'M', place.x(place.first + static_cast<double>(i)),
                   place.y(curve.values[i]));
    drawing = true;
  }
  return format("<path d='%s' fill='none' stroke='%s' stroke-width='1.5'/>\n", path.c_str(), colour);
}

std::string panel_svg(const PanelPlace& place, const CurvePanel& panel) {
  std::string svg = grid_of(place, panel);
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const char* const colour = curve_colours[i % std::size(curve_colours)];
    svg += line_of(place, panel.curves[i], colour);
    svg +=
        format("<text x='%.1f' y='%.1f' fill='%s'>%s</text>\n", curves_margin + 8,
               place.top + 14 + 14 * static_cast<double>(i), colour, xml_text(panel.curves[i].name).c_str());
  }
  return svg;
}

// Of all finite values; 1 where there is none above zero.
double greatest_of(const CurvePanel& panel) {
  double greatest = 0;
  for (const Curve& curve : panel.curves) {
    for (const double value : curve.values) {
      if (std::isfinite(value)) greatest = std::max(greatest, value);
    }
  }
  return greatest > 0 ? greatest * 1.05 : 1;
}

}  // namespace

std::string to_svg(const std::string& title, const std::string& across, double first,
                   const std::vector<CurvePanel>& panels) {
  const double height =
      2 * curves_margin + static_cast<double>(panels.size()) * (panel_height + panel_gap) - panel_gap;
  std::string svg = format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%g' height='%g' font-family='sans-serif' "
      "font-size='11'>\n<rect width='100%%' height='100%%' fill='white'/>\n"
      "<text x='%g' y='30' font-size='14'>%s</text>\n",
      curves_width, height, curves_margin, xml_text(title).c_str());
  double count = 0;
  for (const CurvePanel& panel : panels) {
    for (const Curve& curve : panel.curves) count = std::max(count, static_cast<double>(curve.values.size()));
  }
  PanelPlace place{curves_margin, 1, first, count};
  for (const CurvePanel& panel : panels) {
    place.greatest = greatest_of(panel);
    svg += panel_svg(place, panel);
    place.top += panel_height + panel_gap;
  }
  const double bottom = height - curves_margin;
  const double step = std::max(1.0, grid_step(std::max(count, 1.0)));
  for (double at = std::ceil(first / step) * step; at < first + count; at += step)
    svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>%g</text>\n", place.x(at), bottom + 16, at);
  svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>%s</text>\n", curves_width / 2, bottom + 36,
                xml_text(across).c_str());
  return svg + "</svg>\n";
}

}  // namespace coppice
