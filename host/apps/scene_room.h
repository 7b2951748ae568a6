#pragma once

#include <cstdint>
#include <string>

#include "apps/options.h"
#include "gpu/device.h"
#include "scene/scene.h"

namespace coppice {

// How many bytes this process can still get: the least of what the machine has free, of its memory group's
// limit, and of what its address space may still grow by (ulimit -v).
std::uint64_t bytes_to_be_had();

// Whether a built-in scene of this size can be built, asked before it is made: triangles beyond what a device
// or the memory holds take a minute to make and all of it. `device`: where the tree is built; none on the
// host. Throws InputError with the bytes that are wanted; says on stderr what a large scene will take. Both
// are of the least that its triangles and tree take. Scenes of files pass.
void check_room(const std::string& spec, const Options& options, const Device* device);

// open_scene of options.scene, but for what check_room refuses. `on_device`: whether a device will hold it.
Scene open_scene_with_room(const Options& options, bool on_device);

}  // namespace coppice
