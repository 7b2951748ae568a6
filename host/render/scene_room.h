#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "gpu/device.h"
#include "pipeline/build_plan.h"
#include "scene/scene_source.h"

namespace coppice {

// How many bytes this process can still get: the least of what the machine has free, of its memory group's
// limit, and of what its address space may still grow by (ulimit -v).
std::uint64_t bytes_to_be_had();

// Where a scene will be held beside the host: on a device, with a build on it or a tree that the host hands
// over.
struct DeviceRoom {
  const Device* device = nullptr;
  std::optional<BuildOptions> build;
};

// Whether a built-in scene of this size can be built, asked before it is made: triangles beyond what a device
// or the memory holds take a minute to make and all of it. Throws InputError with the bytes that are wanted;
// tells `note` what a large scene will take. Both are of the least that its triangles and tree take. Scenes
// of files pass.
void check_room(const std::string& spec, const DeviceRoom& room,
                const std::function<void(const std::string&)>& note);

// open_scene and set_lens, but for what check_room refuses. `device`: which one will hold the scene, if any.
Scene open_scene_with_room(const SceneOptions& options, const DeviceOptions* device,
                           const std::optional<BuildOptions>& build,
                           const std::function<void(const std::string&)>& note);

}  // namespace coppice
