#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/open_device.h"
#include "measure/stability_report.h"
#include "scene/input_error.h"

namespace coppice {

namespace {

class StabilityCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    app.add_option("--cases", cases_, "hard cases, see 'coppice scenes --hard'; default: all")
        ->delimiter(',');
    app.add_option("--triangles", options_.most_triangles, "most triangles of a case")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str();
    app.add_option("--rays", options_.rays, "rays of each kind")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str();
    app.add_option("--leak-rays", options_.leak_rays,
                   "rays from inside of each closed mesh at each of five scales; 0: none")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40))
        ->capture_default_str();
    app.add_option("--seed", options_.seed)
        ->check([](const std::string& text) {
          return text.starts_with('-') ? "'" + text + "' is no number from 0 to 2^64 - 1" : std::string();
        })
        ->capture_default_str();
    app.add_option("--seeds", options_.seed_count,
                   "so many seeds from --seed on; of more than one only rows that fail are shown")
        ->check(CLI::Range(1u, 1000000u))
        ->capture_default_str();
    add_ploc(app, options_.builder, device_.choices);
    add_device(app, device_.options);
  }

  int run() override {
    const std::vector<const HardCase*> chosen = chosen_cases();
    CheckedDevice device = open_device(device_, options_.builder);
    const ExaminedCases cases = examine_cases(device, chosen, options_);
    std::vector<LeakCount> leaks;
    if (options_.leak_rays) leaks = count_leaks(device, chosen, options_);
    const double nan_cost = cost_of_nan_rays(device);
    const std::uint64_t failed =
        cases.failed + static_cast<std::uint64_t>(std::ranges::count_if(leaks, &LeakCount::fails));

    if (files.talks()) {
      if (!cases.rows.empty()) print(table_of(cases.rows).text());
      print("\n" + table_of(cases.kinds).text());
      if (!leaks.empty()) print("\n" + table_of(leaks).text());
      print(format("\nA ray with a NaN takes %.2f times as long as a random one.\n", nan_cost));
    }
    Json json = {{"device", device.properties().name},
                 {"driver", device.properties().driver},
                 {"examined", cases.examined},
                 {"cases", Json::array()},
                 {"leaks", table_of(leaks).json()},
                 {"nan_ray_cost", nan_cost},
                 {"failed", failed}};
    for (const StabilityCase& one : cases.rows) json["cases"].push_back(to_json(one));
    write_json(files.json, json);
    const int validation = validation_status(device);
    if (failed)
      std::fprintf(stderr, "coppice: %llu rows are not stable\n", static_cast<unsigned long long>(failed));
    return failed ? 1 : validation;
  }

 private:
  std::vector<const HardCase*> chosen_cases() const {
    std::vector<const HardCase*> cases;
    for (std::string_view name : cases_) {
      if (name.starts_with("hard:")) name.remove_prefix(5);
      cases.push_back(find_hard_case(name));
      if (!cases.back()) throw InputError("--cases: unknown hard case '" + std::string(name) + "'");
    }
    if (cases.empty()) {
      for (const HardCase& hard_case : hard_cases()) cases.push_back(&hard_case);
    }
    return cases;
  }

  std::vector<std::string> cases_;  // empty: all
  StabilityOptions options_;
  DeviceSetup device_;
};

}  // namespace

std::unique_ptr<Command> make_stability() { return std::make_unique<StabilityCommand>(); }

}  // namespace coppice
