#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "apps/option_rules.h"
#include "measure/bench.h"
#include "scene/input_error.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

class BenchCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    std::vector<std::string> names;
    for (const NamedBench& bench : benches()) names.emplace_back(bench.name);
    app.add_option("WHAT", what_)->required()->check(CLI::IsMember(names));
    app.add_option("SCENE", options_.scenes,
                   "of the trace; default: grove and hard:detail-on-ground; of the refit; default: scatter")
        ->expected(1);
    app.add_option("--most", options_.most, "words, keys, triangles or instances of the largest size")
        ->check(CLI::Range(4u, 1u << 26))
        ->capture_default_str();
    app.add_option("--only", options_.only, "only rows of whose name and input this is a part")
        ->type_name("TEXT[,TEXT...]")
        ->delimiter(',');
    app.add_option("--builder", options_.builders,
                   "of build, refit, trace and instances; default: all, gpu-ploc for trace")
        ->delimiter(',')
        ->check(CLI::IsMember(device_builder_names()));
    add_runs(app, options_.runs, "that count, after a warm-up until the median is stable");
    app.add_option("--csv", files.csv, "write the table to FILE")->type_name("FILE");
    add_view(app, picture_, options_.up);
    add_ploc(app, options_.builder, device_.choices);
    add_device(app, device_.options);
  }

  void check(const CLI::App& app) override {
    parse_view(picture_);
    const bool traces = what_ == "trace", refits = what_ == "refit";
    const bool instances = what_ == "instances", sees = traces || instances;
    const bool builds = what_ == "build" || refits || sees;
    const bool has_trees = what_ == "ploc" || builds;
    check_options_matter(app, {{"SCENE", traces || refits, "bench trace or refit"},
                               {"--size", sees, "bench trace or instances"},
                               {"--camera", sees, "bench trace or instances"},
                               {"--up", traces || refits, "bench trace or refit"},
                               {"--builder", builds, "bench build, refit, trace or instances"},
                               {"--radius", has_trees, "bench ploc, build, refit, trace or instances"},
                               {"--morton-bits", has_trees, "bench ploc, build, refit, trace or instances"},
                               {"--variants", has_trees || what_ == "sort",
                                "bench sort, ploc, build, refit, trace or instances"},
                               {"--most", !traces && !(refits && !options_.scenes.empty()),
                                "bench sort, scan, ploc, build, refit or instances"}});
  }

  std::vector<std::string> scenes() const override { return options_.scenes; }

  int run() override {
    options_.trace = picture_.trace;
    options_.camera = picture_.camera;
    CheckedDevice device = open_device(device_, options_.builder);
    const DeviceProperties& properties = device.properties();
    note_timestamps(device);
    std::vector<BenchRow> rows;
    Table table = bench_table();
    if (files.talks()) print(properties.name + ", " + properties.driver + "\n" + table.text_header());
    std::ranges::find(benches(), what_, &NamedBench::name)->run(device, options_, [&](BenchRow row) {
      const Row& added = add_row(table, row);
      if (files.talks()) print(table.text(added));
      std::fflush(stdout);
      rows.push_back(std::move(row));
    });
    if (rows.empty()) throw InputError("bench " + what_ + ": nothing has what --only asks for");
    if (!files.csv.empty()) write_file(files.csv, csv_of(table, properties) + "\n");
    write_json(files.json,
               {{"device", properties.name}, {"driver", properties.driver}, {"rows", to_json(table, rows)}});
    return validation_status(device);
  }

 private:
  std::string what_;  // one of benches()
  BenchOptions options_;
  PictureOptions picture_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_bench() { return std::make_unique<BenchCommand>(); }

}  // namespace coppice
