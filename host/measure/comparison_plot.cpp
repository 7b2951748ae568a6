#include <algorithm>
#include <cmath>
#include <limits>

#include "measure/comparison.h"
#include "measure/comparison_text.h"
#include "measure/table.h"

namespace coppice {

namespace {

constexpr double plot_width = 960, plot_height = 720, plot_margin = 60;

struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = 0;

  void include(double value) {
    if (value <= 0) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void round_to_decades() {
    low = std::pow(10, std::floor(std::log10(low)));
    high = std::pow(10, std::ceil(std::log10(high * 1.001)));
  }
  double position(double value) const { return std::log(value / low) / std::log(high / low); }
};

double plot_x(const Axis& axis, double value) {
  return plot_margin + axis.position(value) * (plot_width - 2 * plot_margin);
}
double plot_y(const Axis& axis, double value) {
  return plot_height - plot_margin - axis.position(value) * (plot_height - 2 * plot_margin);
}

// Finds each label a place near its point where it covers no other label.
class Labels {
 public:
  // The left end of the label's base line.
  std::pair<double, double> place(double x, double y, const std::string& text) {
    const double width = 6.2 * static_cast<double>(text.size());
    for (int step = 0; step < 24; ++step) {
      const double distance = height * ((step + 2) / 4);
      const double left = step % 2 == 0 ? x + 7 : x - 7 - width;
      const double base = y + 4 + (step / 2 % 2 == 0 ? distance : -distance);
      const Box box{left, base - height, left + width, base};
      if (std::ranges::none_of(taken_, [&](const Box& other) { return box.covers(other); }) || step == 23) {
        taken_.push_back(box);
        return {left, base};
      }
    }
    return {x, y};
  }
  void keep_clear(double x, double y) { taken_.push_back({x - 3, y - 3, x + 3, y + 3}); }

 private:
  static constexpr double height = 12;
  struct Box {
    double left, top, right, bottom;
    bool covers(const Box& other) const {
      return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
  };
  std::vector<Box> taken_;
};

std::string plot_grid(const Axis& build, const Axis& frame) {
  std::string svg;
  for (double value = build.low; value <= build.high * 1.001; value *= 10) {
    const double x = plot_x(build, value);
    svg += format(
        "<path d='M%.1f %.1fV%.1f' stroke='#ddd'/><text x='%.1f' y='%.1f' text-anchor='middle'>%g</text>\n",
        x, plot_margin, plot_height - plot_margin, x, plot_height - plot_margin + 16, value);
  }
  for (double value = frame.low; value <= frame.high * 1.001; value *= 10) {
    const double y = plot_y(frame, value);
    svg += format(
        "<path d='M%.1f %.1fH%.1f' stroke='#ddd'/><text x='%.1f' y='%.1f' text-anchor='end'>%g</text>\n",
        plot_margin, y, plot_width - plot_margin, plot_margin - 6, y + 4, value);
  }
  svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>build time, ms</text>\n", plot_width / 2,
                plot_height - 18);
  svg +=
      format("<text transform='translate(18 %.1f) rotate(-90)' text-anchor='middle'>frame time, ms</text>\n",
             plot_height / 2);
  return svg;
}

}  // namespace

std::string to_svg(const std::vector<SceneComparison>& scenes) {
  constexpr const char* colours[] = {"#3b6fb6", "#c0504d", "#5a9e4b", "#8064a2", "#d08a2e", "#3aa6a6"};
  Axis build, frame;
  for (const SceneComparison& scene : scenes) {
    for (const ComparisonRow& row : scene.rows) {
      if (row.infeasible.empty() && row.build_ms > 0)
        build.include(row.build_ms), frame.include(row.frame_ms);
    }
  }
  std::string svg = format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%g' height='%g' font-family='sans-serif' "
      "font-size='11'>\n"
      "<rect width='100%%' height='100%%' fill='white'/>\n",
      plot_width, plot_height);
  if (build.high > 0) {
    build.round_to_decades();
    frame.round_to_decades();
    svg += plot_grid(build, frame);
  }
  const auto has_point = [](const ComparisonRow& row) { return row.infeasible.empty() && row.build_ms > 0; };
  Labels labels;
  for (const SceneComparison& scene : scenes) {
    for (const ComparisonRow& row : scene.rows) {
      if (has_point(row)) labels.keep_clear(plot_x(build, row.build_ms), plot_y(frame, row.frame_ms));
    }
  }
  std::size_t index = 0;
  for (const SceneComparison& scene : scenes) {
    const char* const colour = colours[index % std::size(colours)];
    svg += format("<text x='%g' y='%g' fill='%s'>%s</text>\n", plot_margin + 10,
                  plot_margin - 34 + 13 * static_cast<double>(index), colour, xml_text(scene.scene).c_str());
    ++index;
    for (const ComparisonRow& row : scene.rows) {
      if (!has_point(row)) continue;
      const double x = plot_x(build, row.build_ms), y = plot_y(frame, row.frame_ms);
      const auto [label_x, label_y] = labels.place(x, y, row.builder);
      svg += format(
          "<circle cx='%.1f' cy='%.1f' r='4' fill='%s'/><path d='M%.1f %.1fL%.1f %.1f' stroke='%s' "
          "stroke-width='0.5'/><text x='%.1f' y='%.1f' fill='%s'>%s</text>\n",
          x, y, colour, x, y, label_x + (label_x < x ? 6.2 * static_cast<double>(row.builder.size()) : 0),
          label_y - 4, colour, label_x, label_y, colour, row.builder.c_str());
    }
  }
  return svg + "</svg>\n";
}

}  // namespace coppice
