#include "render/scene_room.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>

#include "interface/instances.h"
#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t small_triangles = 1u << 20;            // what any machine holds
constexpr std::uint64_t large_bytes = std::uint64_t{1} << 30;  // worth a line on stderr

// The number behind `key` in a file of lines "key number kB"; with an empty key the first number of the file.
std::optional<std::uint64_t> number_in(const char* path, const std::string& key) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (key.empty()) return file >> number ? std::optional(number) : std::nullopt;
  for (std::string word; file >> word;) {
    if (word == key && file >> number) return number * 1024;
  }
  return std::nullopt;
}

// The scene, its arrays for the stages and what makes them, and the tree: all on the host at once.
std::uint64_t host_bytes_of(const SceneSize& size) {
  constexpr std::uint64_t vertex = 2 * sizeof(vec3);
  constexpr std::uint64_t triangle =
      sizeof(uvec3) + sizeof(uint) + sizeof(Triangle) + sizeof(uint) + 2 * sizeof(Node);
  return vertex * size.vertices + triangle * size.triangles;
}

// Of the triangles and of a build with the shortest codes, or of a tree that the host hands over.
std::uint64_t device_bytes_of(const SceneSize& size, const DeviceRoom& room) {
  Layout layout(room.device->properties().max_block_bytes);
  const auto count = static_cast<std::uint32_t>(size.triangles);
  if (room.build) {
    plan_build(layout, count, *room.build);
  } else {
    plan_tree(layout, count, 2 * size.triangles - 1);
  }
  std::uint64_t bytes = 0;
  for (const std::uint64_t block : layout.block_bytes()) bytes += block;
  return bytes;
}

// Of each instance what the scene and its arrays hold, and what a device does that shares the host's memory:
// transforms, boxes, and a tree of the builder that takes the most.
void check_instance_room(const std::string& spec, const SceneSize& size) {
  constexpr std::uint64_t on_host = sizeof(Instance) + sizeof(uint) + sizeof(InstanceTransform);
  constexpr std::uint64_t on_device = sizeof(InstanceTransform) + sizeof(PlacedInstance) + 2 * sizeof(Aabb) +
                                      4 * sizeof(Node) + 6 * sizeof(uint);
  const std::uint64_t wanted = size.instances * (on_host + on_device), had = bytes_to_be_had();
  if (wanted <= had) return;
  throw InputError("scene '" + printable(std::string_view(spec)) + "' needs at least " +
                   std::to_string(wanted) + " bytes of memory, and " + std::to_string(had) +
                   " are to be had");
}

std::string gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

}  // namespace

std::uint64_t bytes_to_be_had() {
  std::uint64_t least = unlimited;
  if (const auto available = number_in("/proc/meminfo", "MemAvailable:"))
    least = *available + number_in("/proc/meminfo", "SwapFree:").value_or(0);
  if (const auto group = number_in("/sys/fs/cgroup/memory.max", "")) least = std::min(least, *group);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const std::uint64_t used = number_in("/proc/self/status", "VmSize:").value_or(0);
    least = std::min<std::uint64_t>(least, limit.rlim_cur > used ? limit.rlim_cur - used : 0);
  }
  return least;
}

void check_room(const std::string& spec, const DeviceRoom& room,
                const std::function<void(const std::string&)>& note) {
  const Device* const device = room.device;
  const std::optional<SceneSize> size = built_in_size(spec);
  if (!size || size->triangles <= small_triangles) return;
  const std::string scene = "scene '" + printable(std::string_view(spec)) + "'";
  const std::uint64_t host = host_bytes_of(*size);
  std::uint64_t on_device = 0;
  try {
    if (device) on_device = device_bytes_of(*size, room);
  } catch (const LayoutError& error) {
    throw InputError(scene + ": " + error.what());
  }
  const bool shared = device && device->properties().shared_memory;
  const std::uint64_t wanted = host + (shared ? on_device : 0), had = bytes_to_be_had();
  if (wanted > had) {
    throw InputError(scene + " needs at least " + std::to_string(wanted) + " bytes of memory, and " +
                     std::to_string(had) + " are to be had");
  }
  if (device && on_device > device->properties().memory_bytes) {
    throw InputError(scene + " needs at least " + std::to_string(on_device) + " bytes on " +
                     device->properties().name + ", which has " +
                     std::to_string(device->properties().memory_bytes));
  }
  if (host + on_device < large_bytes) return;
  note(scene + " takes at least " + gigabytes(host + on_device) + " of memory" +
       (device ? ", " + gigabytes(on_device) + " of it on " + device->properties().name : ""));
}

Scene open_scene_with_room(const SceneOptions& options, const DeviceOptions* device,
                           const std::optional<BuildOptions>& build,
                           const std::function<void(const std::string&)>& note) {
  const std::optional<SceneSize> size = built_in_size(options.spec);
  if (size && size->instances > 0 && options.keep_instances) {
    check_instance_room(options.spec, *size);
  } else if (size && size->triangles > small_triangles) {
    std::optional<Device> opened;
    if (device) opened.emplace(DeviceOptions{.select = device->select});
    check_room(options.spec, {opened ? &*opened : nullptr, build}, note);
  }
  Scene scene = open_scene(options.spec, options.up, options.keep_instances);
  set_lens(scene, options);
  set_environment(scene, options);
  scene.bounces = options.bounces.value_or(scene.bounces);
  return scene;
}

}  // namespace coppice
