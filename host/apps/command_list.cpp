#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "gpu/device.h"
#include "gpu/no_driver.h"
#include "measure/table.h"
#include "scene/scene_source.h"

namespace coppice {

namespace {

class ScenesCommand : public Command {
 public:
  void add_options(CLI::App& app) override {
    app.add_flag("--hard", hard_, "the inputs that are hard on builders and tracers instead");
  }

  int run() override {
    Table table({{.key = "name", .width = hard_ ? -27 : -12, .gap = 0},
                 {.key = "triangles", .width = 9},
                 {.key = "description", .gap = 2},
                 {.key = "takes_count", .places = IN_JSON}});
    for (const SceneListing& scene : hard_ ? list_hard_scenes() : list_scenes()) {
      const std::string name = scene.name + (scene.takes_count && !hard_ ? "[:N]" : "");
      table.add({{Cell(scene.name).shown_as(name), scene.triangles, scene.description, scene.takes_count}});
    }
    if (files.talks()) {
      for (const Row& row : table.rows()) print(table.text(row));
      print(hard_ ? "Each takes a number of triangles and a seed: hard:NAME[:N[:SEED]]\n"
                  : "Inputs that are hard on builders and tracers: coppice scenes --hard\n"
                    "Files: .obj, .gltf, .glb, .ply, .anim, and scene files .json (docs/scenes.md)\n");
    }
    write_json(files.json, table.json());
    return 0;
  }

 private:
  bool hard_ = false;
};

class DevicesCommand : public Command {
 public:
  void add_options(CLI::App&) override {}

  int run() override {
    Table table({{.key = "index", .gap = 0},
                 {.key = "type", .width = -10, .gap = 2},
                 {.key = "name"},
                 {.key = "driver", .places = IN_JSON},
                 {.key = "suitable", .places = IN_JSON}});
    for (const DeviceListing& device : list_devices()) {
      const std::string& reason = device.unsuitable_because;
      const std::string name =
          device.name + ", " + device.driver + (reason.empty() ? "" : "; unsuitable: ") + reason;
      table.add({{device.index, to_string(device.type), Cell(device.name).shown_as(name), device.driver,
                  reason.empty()}});
    }
    if (files.talks()) {
      for (const Row& row : table.rows()) print(table.text(row));
    }
    write_json(files.json, table.json());
    if (table.rows().empty()) throw DeviceError(why_no_device());
    return 0;
  }
};

}  // namespace

std::unique_ptr<Command> make_scenes() { return std::make_unique<ScenesCommand>(); }
std::unique_ptr<Command> make_devices() { return std::make_unique<DevicesCommand>(); }

}  // namespace coppice
