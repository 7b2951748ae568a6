#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "measure/tune.h"
#include "pipeline/variant_table.h"
#include "scene/write_file.h"

namespace coppice {

namespace {

class TuneCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    app.add_option("--most", options_.most, "keys that the sort is measured on")
        ->check(CLI::Range(4u, 1u << 26))
        ->capture_default_str();
    add_runs(app, options_.runs, "of each variant, after a warm-up until the median is stable");
    add_size(app, picture_);  // the trace is measured on a quarter of its rays
    add_lookback(app, device_.choices);
    add_device(app, device_.options);
  }

  void check(const CLI::App&) override { parse_view(picture_); }

  int run() override {
    options_.trace = picture_.trace;
    CheckedDevice device = open_device(device_, options_.builder);
    const DeviceProperties& properties = device.properties();
    const std::filesystem::path file = checked_table_file(device.device());
    if (files.talks()) {
      print(properties.name + ", " + properties.driver + "\n" + tuning_table().text_header());
      if (!device.lookback()) print("  without lookback, and so without the variants that need it\n");
    }
    Json stages = Json::array();
    for (const VariantStage& stage : variant_stages()) {
      const TunedStage tuned = tune_stage(device, stage, options_);
      if (files.talks()) {
        for (const Row& row : tuned.variants.rows()) print(tuned.variants.text(row));
      }
      stages.push_back(to_json(tuned));
    }
    write_file(file, variant_table_text(device.variants(), properties));
    if (files.talks()) print("written to " + file.string() + "\n");
    write_json(files.json, {{"device", properties.name},
                            {"driver", properties.driver},
                            {"stages", stages},
                            {"file", file.string()}});
    return validation_status(device);
  }

 private:
  BenchOptions options_;
  PictureOptions picture_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_tune() { return std::make_unique<TuneCommand>(); }

}  // namespace coppice
