#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "apps/command.h"
#include "apps/option_groups.h"
#include "apps/option_rules.h"
#include "measure/child_process.h"
#include "measure/comparison.h"
#include "measure/progress.h"
#include "measure/table.h"
#include "scene/input_error.h"
#include "scene/scene_source.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

// At about 500, 100,000, 1,000,000 and 3,000,000 triangles, as in the report's Table I.
const std::vector<std::string> default_scenes = {"terrain:500", "scatter:100000", "scatter:1000000",
                                                 "scatter:3000000"};

class CompareCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    app.add_option("SCENE", scenes_, "default: four generated ones of 500 to 3,000,000 triangles");
    app.add_option("--builders", builders_, "default: all")
        ->delimiter(',')
        ->check(CLI::IsMember(builder_names()));
    add_size(app, picture_);
    app.add_option("--timeout", timeout_seconds_, "seconds a row may take")
        ->check(CLI::Range(0.1, 86400.0))
        ->check([](const std::string& text) {  // which any range lets pass
          return std::isnan(std::strtod(text.c_str(), nullptr)) ? "not a number" : std::string();
        })
        ->capture_default_str();
    app.add_option("--markdown", files.markdown, "write the tables to FILE")->type_name("FILE");
    app.add_option("--plot", files.plot, "write build time against frame time as SVG")->type_name("FILE");
    add_named_device(app, device_.options);
    add_intersection(app, picture_.trace);
    add_runs(app, runs_, "build and trace so many times; times are medians");
    add_leaf_size(app, builder_);
    add_ploc(app, builder_, device_.choices);
  }

  void check(const CLI::App& app) override {
    parse_view(picture_);
    const bool on_device = builders_.empty() || std::ranges::any_of(builders_, [](const std::string& name) {
                             return find_device_builder(name) != nullptr;
                           });
    check_options_matter(app, {{"--lookback", on_device, NEEDS_DEVICE_BUILDER},
                               {"--variants", on_device, NEEDS_DEVICE_BUILDER}});
  }

  std::vector<std::string> scenes() const override { return scenes_; }

  int run() override {
    if (scenes_.empty()) scenes_ = default_scenes;
    if (builders_.empty()) builders_ = builder_names();
    std::string device;
    const std::vector<SceneComparison> comparison = compare(device);
    const std::string conditions =
        "Traced on " + (device.empty() ? "no device" : device) + " at " + size_word() +
        ", one ray a pixel; " + (runs_ == 1 ? "one run" : "medians of " + std::to_string(runs_) + " runs") +
        ". X: infeasible, with the reason.";
    const std::string markdown = to_markdown(comparison, conditions);
    if (files.talks()) print(markdown);
    if (!files.markdown.empty()) write_file(files.markdown, markdown + "\n");
    if (!files.plot.empty()) write_file(files.plot, to_svg(comparison) + "\n");
    write_json(files.json, to_json(comparison));
    const bool any_row = std::ranges::any_of(comparison, [](const SceneComparison& scene) {
      return std::ranges::any_of(scene.rows, [](const ComparisonRow& row) { return row.infeasible.empty(); });
    });
    if (!any_row) throw InputError("no builder gave a result");
    return 0;
  }

 private:
  std::string size_word() const {
    return std::to_string(picture_.trace.width) + "x" + std::to_string(picture_.trace.height);
  }

  std::vector<SceneComparison> compare(std::string& device) const {
    std::vector<SceneComparison> comparison;
    std::set<std::string> notes;  // of the children, each said once
    Progress progress("comparing", static_cast<std::uint32_t>(scenes_.size() * builders_.size()));
    for (const std::string& name : scenes_) {
      // Opened here too, so that a scene that cannot be read is an error and no row of X; but not made.
      const std::optional<SceneSize> size = built_in_size(name);
      SceneComparison scene{name, size ? size->triangles : open_scene(name).indices.size(), {}};
      for (const std::string& builder : builders_) {
        Json render;
        scene.rows.push_back(measure(name, builder, render, notes));
        if (device.empty() && !render.is_null()) device = render.at("trace_device");
        progress.step();
      }
      comparison.push_back(std::move(scene));
    }
    return comparison;
  }

  std::vector<std::string> arguments(const std::string& scene, const std::string& builder) const {
    std::vector<std::string> words = {"render", scene, "--builder", builder,
                                      "--json", "-",   "-o",        "/dev/null"};
    words.push_back("--effects=" + no_effects());  // builders are compared by the camera's rays
    const auto add = [&](const char* flag, const std::string& value) {
      words.insert(words.end(), {flag, value});
    };
    add("--size", size_word());
    add("--runs", std::to_string(runs_));
    add("--radius", std::to_string(builder_.radius));
    add("--leaf-size", std::to_string(builder_.leaf_size));
    add("--tree", "binary");  // the builders' own
    add("--triangle-test", word_of_triangle_test(picture_.trace.triangle_test));
    add("--box-test", word_of_box_test(picture_.trace.box_test));
    add("--morton-bits", word_of_morton_bits(builder_.morton_bits));
    add("--variants", device_.choices.variants);
    if (!device_.options.select.empty()) add("--device", device_.options.select);
    // Only what a device builds has prefix sums.
    if (find_device_builder(builder)) add("--lookback", word_of_lookback(device_.choices.lookback));
    return words;
  }

  // Each row is a process of its own, which can be ended when its time is over.
  ComparisonRow measure(const std::string& scene, const std::string& builder, Json& render,
                        std::set<std::string>& notes) const {
    const ChildResult child = run_self(arguments(scene, builder), timeout_seconds_);
    for (const std::string& note : child.notes) {
      if (notes.insert(note).second) std::fprintf(stderr, "%s\n", note.c_str());
    }
    ComparisonRow row;
    row.builder = builder;
    if (child.timed_out) {
      row.infeasible = format("over %g s", timeout_seconds_);
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

  std::vector<std::string> scenes_, builders_;  // empty: the default ones
  double timeout_seconds_ = 60;
  std::uint32_t runs_ = 1;
  PictureOptions picture_;
  BuilderChoice builder_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_compare() { return std::make_unique<CompareCommand>(); }

}  // namespace coppice
