#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/options.h"
#include "apps/report.h"
#include "gpu/device.h"
#include "gpu/no_driver.h"
#include "scene/scene_source.h"

namespace coppice {

int run_scenes(const Options& options) {
  Json rows = Json::array();
  for (const SceneListing& scene : options.hard ? list_hard_scenes() : list_scenes()) {
    const std::string name = scene.name + (scene.takes_count && !options.hard ? "[:N]" : "");
    if (talks(options))
      std::printf("%-*s %9u  %s\n", options.hard ? 27 : 12, name.c_str(), scene.triangles,
                  scene.description.c_str());
    rows.push_back({{"name", scene.name},
                    {"triangles", scene.triangles},
                    {"description", scene.description},
                    {"takes_count", scene.takes_count}});
  }
  if (talks(options)) {
    std::puts(options.hard ? "Each takes a number of triangles and a seed: hard:NAME[:N[:SEED]]"
                           : "Inputs that are hard on builders and tracers: coppice scenes --hard");
  }
  write_json(options.json, rows);
  return 0;
}

int run_devices(const Options& options) {
  Json rows = Json::array();
  const auto devices = list_devices();
  for (const DeviceListing& device : devices) {
    const std::string& reason = device.unsuitable_because;
    if (talks(options)) {
      std::printf("%u  %-10s %s, %s%s%s\n", device.index, to_string(device.type), device.name.c_str(),
                  device.driver.c_str(), reason.empty() ? "" : "; unsuitable: ", reason.c_str());
    }
    rows.push_back({{"index", device.index},
                    {"type", to_string(device.type)},
                    {"name", device.name},
                    {"driver", device.driver},
                    {"suitable", reason.empty()}});
  }
  write_json(options.json, rows);
  if (devices.empty()) throw DeviceError(why_no_device());
  return 0;
}

}  // namespace coppice
