// Another program's frame: ten scenes built in one command buffer with one scratch, then rays through each of
// them, on a device that this program has made. The trees must be those of Coppice's own program.
//   consumer COPPICE FOLDER    COPPICE: that program; FOLDER: where scenes are written for it to read
#include <coppice/build.h>
#include <coppice/trace.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>
#include <random>

#include "own_device.h"

namespace {

std::uint64_t allocations = 0;

}  // namespace

void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* const memory = std::malloc(bytes ? bytes : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace consumer {
namespace {

struct Scene {
  std::vector<float> vertices;  // three a vertex
  std::vector<std::uint32_t> indices;
};

// Triangles of random places and sizes, some of which share their corners.
Scene make_scene(std::uint32_t triangles, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  Scene scene;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    // About the origin: the program moves scenes that are too far from it.
    const float wide = i == 0 ? 0.0f : 10.0f, size = 0.05f + next() * next();
    const float x = (next() - 0.5f) * wide, y = (next() - 0.5f) * wide, z = (next() - 0.5f) * wide;
    for (int corner = 0; corner < 3; ++corner) {
      for (const float at : {x, y, z}) scene.vertices.push_back(at + next() * size);
    }
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      scene.indices.push_back(corner == 0 && i > 0 && seed % 2 == 1 ? 3 * i - 1 : 3 * i + corner);
  }
  return scene;
}

void write_obj(const Scene& scene, const std::string& path) {
  std::ofstream file(path);
  char line[128];
  for (std::size_t i = 0; i < scene.vertices.size(); i += 3) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", scene.vertices[i], scene.vertices[i + 1],
                  scene.vertices[i + 2]);
    file << line;
  }
  for (std::size_t i = 0; i < scene.indices.size(); i += 3)
    file << "f " << scene.indices[i] + 1 << ' ' << scene.indices[i + 1] + 1 << ' ' << scene.indices[i + 2] + 1
         << '\n';
  if (!file.flush()) fail("cannot write " + path);
}

// What Coppice's program says of the tree over a scene.
std::string hash_by_program(const std::string& program, const std::string& obj, const std::string& builder) {
  const std::string command =
      "'" + program + "' build '" + obj + "' --builder " + builder + " --json - 2>/dev/null";
  FILE* const pipe = popen(command.c_str(), "r");
  if (!pipe) fail("cannot run " + program);
  std::string text;
  char piece[4096];
  while (const std::size_t count = std::fread(piece, 1, sizeof piece, pipe)) text.append(piece, count);
  if (pclose(pipe) != 0) fail(command + " failed");
  const std::string key = "\"tree_hash\": \"";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) fail(command + " said no tree_hash");
  return text.substr(at + key.size(), 16);
}

constexpr std::uint32_t sizes[] = {1, 2, 100, 896, 897, 2000, 5000, 10000, 20000, 50000};

std::vector<std::string> hashes_by_program(const std::string& program, const std::string& folder) {
  std::vector<std::string> hashes;
  for (const std::uint32_t size : sizes) {
    const std::string obj = folder + "/scene" + std::to_string(size) + ".obj";
    write_obj(make_scene(size, size), obj);
    hashes.push_back(hash_by_program(program, obj, "gpu-ploc"));
  }
  return hashes;
}

// As docs/numerics.md has it: FNV-1a over the words of the nodes.
std::string hash_of(std::span<const CoppiceNode> nodes) {
  std::uint64_t hash = 14695981039346656037u;
  const auto* words = reinterpret_cast<const std::uint32_t*>(nodes.data());
  for (std::size_t i = 0; i < nodes.size() * 8; ++i) hash = (hash ^ words[i]) * 1099511628211u;
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

constexpr std::uint32_t ray_count = 4096;

std::vector<CoppiceRay> make_rays(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  std::vector<CoppiceRay> rays(ray_count);
  for (CoppiceRay& ray : rays) {
    ray = {{(next() - 0.5f) * 10, (next() - 0.5f) * 10, (next() - 0.5f) * 10},
           0,
           {next() - 0.5f, next() - 0.5f, next() - 0.5f},
           std::numeric_limits<float>::infinity()};
  }
  return rays;
}

// A scene in the device's memory, its tree, and what rays find there.
struct Built {
  std::uint32_t triangles;
  Buffer vertices, indices, tree, hits, any_hits;
  coppice::TreeAddresses addresses;
  std::string program_hash;
};

VkDeviceSize address_in(const Built& built, VkDeviceAddress address) { return address - built.tree.address; }

void expect_tree(const Built& built) {
  const auto& state = built.tree.as<CoppiceTreeState>(address_in(built, built.addresses.state))[0];
  if (state.error_word != 0) fail("error word " + std::to_string(state.error_word));
  if (state.active_count != built.triangles) fail("a tree of too few triangles");
  const auto nodes = built.tree.as<CoppiceNode>(address_in(built, built.addresses.nodes));
  const std::string hash = hash_of(nodes.first(2 * built.triangles - 1));
  std::printf("  %6u triangles: %s\n", built.triangles, hash.c_str());
  if (hash != built.program_hash) fail("the program's tree is " + built.program_hash);
}

void expect_hits(const Built& built) {
  std::uint32_t hits = 0;
  for (std::uint32_t i = 0; i < ray_count; ++i) {
    const bool is_hit = built.hits.as<CoppiceHit>()[i].primitive != COPPICE_NO_PRIMITIVE;
    if (is_hit != (built.any_hits.as<std::uint32_t>()[i] == 1)) fail("closest and any hit disagree");
    hits += is_hit;
  }
  if (built.triangles > 1000 && hits < ray_count / 20) fail("too few hits: " + std::to_string(hits));
}

// With or without the validation layers, which allocate by our operator new.
void run(const std::vector<std::string>& program_hashes, bool validate) {
  const coppice::RequiredFeatures features;
  OwnDevice own(features.features, validate);
  coppice::AdoptedDevice adopted;
  adopted.instance = own.instance;
  adopted.physical_device = own.physical;
  adopted.device = own.device;
  adopted.queue_family = OwnDevice::family;
  adopted.enabled_features = &features.features;
  adopted.queue = own.queue;
  const coppice::Context context(adopted);
  std::printf("%s, %s\n", context.capabilities().name.c_str(), context.capabilities().driver.c_str());

  const coppice::Builder builder(context, 50000);
  const coppice::Tracer tracer(context);
  const Buffer scratch = own.make_buffer(builder.sizes().scratch_bytes);
  const coppice::MemoryRange scratch_range{scratch.buffer, 0, scratch.bytes};
  const Buffer rays = own.upload(std::span<const CoppiceRay>(make_rays(1)));
  std::vector<Built> scenes;
  for (const std::uint32_t size : sizes) {
    const Scene scene = make_scene(size, size);
    const Buffer tree = own.make_buffer(builder.sizes().tree_bytes);
    scenes.push_back({size, own.upload(std::span<const float>(scene.vertices)),
                      own.upload(std::span<const std::uint32_t>(scene.indices)), tree,
                      own.make_buffer(ray_count * sizeof(CoppiceHit)), own.make_buffer(ray_count * 4),
                      builder.triangle_tree({tree.buffer, 0, tree.bytes}), program_hashes[scenes.size()]});
  }

  const VkCommandBuffer commands = own.begin();
  const std::uint64_t allocations_before = allocations;
  const auto start = std::chrono::steady_clock::now();
  for (const Built& one : scenes) {
    coppice::TriangleInput input;
    input.vertices = one.vertices.address;
    input.vertex_count = 3 * one.triangles;
    input.indices = one.indices.address;
    input.count.maximum = one.triangles;
    builder.cmd_build(commands, input, {one.tree.buffer, 0, one.tree.bytes}, scratch_range);
  }
  const std::chrono::duration<double, std::milli> recording = std::chrono::steady_clock::now() - start;
  for (const Built& one : scenes) {
    coppice::RayInput input;
    input.rays = rays.address;
    input.count.maximum = ray_count;
    tracer.cmd_trace_closest(commands, one.addresses, input, one.hits.address, scratch_range);
    tracer.cmd_trace_any(commands, one.addresses, input, one.any_hits.address, scratch_range);
  }
  const std::uint64_t while_recording = allocations - allocations_before;
  own.run(commands);

  for (const Built& one : scenes) {
    expect_tree(one);
    expect_hits(one);
  }
  for (const std::string& message : own.take_messages()) fail("validation: " + message);
  if (validate) return;
  std::printf("recording: %.3f ms a build, %llu allocations\n", recording.count() / std::size(sizes),
              static_cast<unsigned long long>(while_recording));
  if (while_recording != 0) fail("recording allocates");
}

}  // namespace
}  // namespace consumer

int main(int argc, char** argv) {
  if (argc != 3) consumer::fail("usage: consumer COPPICE FOLDER");
  try {
    const std::vector<std::string> hashes = consumer::hashes_by_program(argv[1], argv[2]);
    consumer::run(hashes, true);
    consumer::run(hashes, false);
    return 0;
  } catch (const std::exception& error) {
    consumer::fail(error.what());
  }
}
