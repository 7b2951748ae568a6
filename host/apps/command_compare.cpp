#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "apps/child_process.h"
#include "apps/comparison.h"
#include "apps/progress.h"
#include "builders/registry.h"
#include "pipeline/build.h"
#include "scene/input_error.h"
#include "scene/scene_source.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

// At about 500, 100,000, 1,000,000 and 3,000,000 triangles, as in the report's Table I.
const std::vector<std::string> default_scenes = {"terrain:500", "scatter:100000", "scatter:1000000",
                                                 "scatter:3000000"};

std::vector<std::string> all_builders() {
  std::vector<std::string> names;
  for (const CpuBuilder& builder : cpu_builders()) names.emplace_back(builder.name);
  for (const NamedDeviceBuilder& named : device_builders()) names.emplace_back(named.name);
  return names;
}

// Each row is a process of its own, which can be ended when its time is over.
ComparisonRow measure(const std::string& scene, const std::string& builder, const Options& options,
                      Json& render, std::set<std::string>& notes) {
  std::vector<std::string> arguments = {"render", scene, "--builder", builder,
                                        "--json", "-",   "-o",        "/dev/null"};
  const auto add = [&](const char* flag, const std::string& value) {
    arguments.insert(arguments.end(), {flag, value});
  };
  add("--size", std::to_string(options.width) + "x" + std::to_string(options.height));
  add("--runs", std::to_string(options.frames));
  add("--radius", std::to_string(options.radius));
  add("--leaf-size", std::to_string(options.leaf_size));
  add("--tree", "binary");  // the builders' own
  add("--triangle-test", options.triangle_test);
  add("--box-test", options.box_test);
  add("--morton-bits", options.morton_bits);
  add("--variants", options.variants);
  if (!options.device.empty()) add("--device", options.device);
  // Only what a device builds has prefix sums.
  if (find_device_builder(builder)) add("--lookback", options.lookback);
  const ChildResult child = run_self(arguments, options.timeout_seconds);
  for (const std::string& note : child.notes) {
    if (notes.insert(note).second) std::fprintf(stderr, "%s\n", note.c_str());
  }
  ComparisonRow row;
  row.builder = builder;
  if (child.timed_out) {
    char text[64];
    std::snprintf(text, sizeof text, "over %g s", options.timeout_seconds);
    row.infeasible = text;
  } else if (child.exit_status != 0) {
    constexpr std::string_view prefix = "coppice: ";
    const std::string_view line = child.error;
    row.infeasible = "failed: " + std::string(line.substr(line.starts_with(prefix) ? prefix.size() : 0));
  } else {
    render = Json::parse(child.output);
    row = comparison_row(builder, render);
  }
  return row;
}

}  // namespace

int run_compare(const Options& options) {
  const std::vector<std::string> scenes = options.scenes.empty() ? default_scenes : options.scenes;
  const std::vector<std::string> builders = options.builders.empty() ? all_builders() : options.builders;
  std::vector<SceneComparison> comparison;
  std::string conditions;
  std::set<std::string> notes;  // of the children, each said once
  {
    Progress progress("comparing", static_cast<std::uint32_t>(scenes.size() * builders.size()));
    for (const std::string& name : scenes) {
      // Opened here too, so that a scene that cannot be read is an error and no row of X; but not made.
      const std::optional<SceneSize> size = built_in_size(name);
      SceneComparison scene{name, size ? size->triangles : open_scene(name).indices.size(), {}};
      for (const std::string& builder : builders) {
        Json render;
        scene.rows.push_back(measure(name, builder, options, render, notes));
        if (conditions.empty() && !render.is_null()) conditions = render.at("trace_device");
        progress.step();
      }
      comparison.push_back(std::move(scene));
    }
  }
  conditions = "Traced on " + (conditions.empty() ? "no device" : conditions) + " at " +
               std::to_string(options.width) + "x" + std::to_string(options.height) + ", one ray a pixel; " +
               (options.frames == 1 ? "one run" : "medians of " + std::to_string(options.frames) + " runs") +
               ". X: infeasible, with the reason.";
  const std::string markdown = to_markdown(comparison, conditions);
  if (talks(options)) std::printf("%s", markdown.c_str());
  if (!options.markdown.empty()) write_file(options.markdown, markdown + "\n");
  if (!options.plot.empty()) write_file(options.plot, to_svg(comparison) + "\n");
  write_json(options.json, to_json(comparison));
  const bool any_row = std::ranges::any_of(comparison, [](const SceneComparison& scene) {
    return std::ranges::any_of(scene.rows, [](const ComparisonRow& row) { return row.infeasible.empty(); });
  });
  if (!any_row) throw InputError("no builder gave a result");
  return 0;
}

}  // namespace coppice
