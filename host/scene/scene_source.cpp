#include "scene/scene_source.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "scene/generators.h"
#include "scene/hard_cases.h"
#include "scene/input_error.h"
#include "scene/instances.h"
#include "scene/load_gltf.h"
#include "scene/load_obj.h"
#include "scene/load_ply.h"
#include "scene/obj_file.h"
#include "scene/printable.h"
#include "scene/scene_file.h"
#include "scene/scene_file_meshes.h"

namespace coppice {
namespace {

constexpr std::uint32_t SCATTER_DEFAULT = 1'000'000;
constexpr std::uint32_t TERRAIN_DEFAULT = 500'000;
constexpr std::uint32_t MOVING_DEFAULT = 100'000;
constexpr std::uint32_t INSTANCES_DEFAULT = 10'000;

// "name:rest" as its two parts; no second part where there is no colon.
struct NameAndRest {
  std::string_view name;
  std::optional<std::string_view> rest;
};

NameAndRest split(std::string_view spec) {
  const std::size_t colon = spec.find(':');
  if (colon == std::string_view::npos) return {spec, std::nullopt};
  return {spec.substr(0, colon), spec.substr(colon + 1)};
}

std::uint32_t parse_count(const std::string& spec, std::optional<std::string_view> text,
                          std::uint32_t otherwise, std::string_view of = "triangles") {
  if (!text) return otherwise;
  std::uint32_t count = 0;
  const char* const end = text->data() + text->size();
  const auto [parsed_end, error] = std::from_chars(text->data(), end, count);
  if (parsed_end != end || error != std::errc{} || count == 0 || count > MAX_GENERATED_TRIANGLES) {
    throw InputError("scene '" + printable(std::string_view(spec)) + "': '" + printable(*text) +
                     "' is no number of " + std::string(of) + " from 1 to " +
                     std::to_string(MAX_GENERATED_TRIANGLES));
  }
  return count;
}

std::uint64_t parse_seed(const std::string& spec, std::optional<std::string_view> text) {
  if (!text) return 1;
  std::uint64_t seed = 0;
  const char* const end = text->data() + text->size();
  const auto [parsed_end, error] = std::from_chars(text->data(), end, seed);
  if (parsed_end != end || error != std::errc{}) {
    throw InputError("scene '" + printable(std::string_view(spec)) + "': '" + printable(*text) +
                     "' is no seed from 0 to " + std::to_string(UINT64_MAX));
  }
  return seed;
}

// A scene that a number of triangles is given for, read but not yet made.
struct BuiltIn {
  SceneSize size;
  std::function<Scene()> make;
};

BuiltIn find_hard(const std::string& spec) {
  const auto [name, numbers] = split(std::string_view(spec).substr(5));
  const HardCase* const hard_case = find_hard_case(name);
  if (!hard_case) {
    std::string known;
    for (const HardCase& other : hard_cases()) known.append(known.empty() ? "" : ", ").append(other.name);
    throw InputError("unknown hard case '" + printable(name) + "': there are " + known);
  }
  std::optional<std::string_view> count, seed_text;
  if (numbers) {
    const NameAndRest parts = split(*numbers);
    count = parts.name;
    seed_text = parts.rest;
  }
  const std::uint32_t asked = parse_count(spec, count, hard_case->default_triangle_count);
  const std::uint64_t seed = parse_seed(spec, seed_text);
  const std::uint64_t triangles = hard_case->triangle_count(asked);
  return {{triangles, 3 * triangles}, [=] {
            Scene scene = hard_case->make(asked, seed);
            scene.name = spec;
            return scene;
          }};
}

std::optional<BuiltIn> find_built_in(const std::string& spec) {
  if (spec.starts_with("hard:")) return find_hard(spec);
  const auto [name, text] = split(spec);
  if (name == "scatter") {
    const std::uint32_t count = parse_count(spec, text, SCATTER_DEFAULT);
    return BuiltIn{{count, std::uint64_t{3} * count}, [=] { return make_scatter(count); }};
  }
  if (name == "terrain") {
    const std::uint32_t count = parse_count(spec, text, TERRAIN_DEFAULT);
    return BuiltIn{{count, count / 2 + 1}, [=] { return make_terrain(count); }};
  }
  if (name == "instances") {
    const std::uint32_t count = parse_count(spec, text, INSTANCES_DEFAULT, "instances");
    const std::uint64_t triangles = swarm_triangles(count);
    return BuiltIn{{triangles, 3 * triangles, count}, [=] { return make_instances(count); }};
  }
  if (name == "moving") {
    const std::uint32_t count = parse_count(spec, text, MOVING_DEFAULT);
    // At most: two fifths of unshared corners, the rest in grids.
    return BuiltIn{{count, std::uint64_t{2} * count + 64}, [=] { return make_moving(count); }};
  }
  return std::nullopt;
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

// The faces of x.anim are those of x_f00.obj beside it.
Scene open_anim(const std::filesystem::path& path) {
  const ObjFile file = read_obj_file(path);
  const std::filesystem::path faces = path.parent_path() / (path.stem().string() + "_f00.obj");
  std::error_code error;
  if (!std::filesystem::exists(faces, error)) {
    throw InputError(printable(path) + ": holds no faces, expected them in " + printable(faces.filename()) +
                     " beside it; a scene file can name another OBJ");
  }
  Scene scene = make_anim_scene(std::string(file.text()), printable(path), load_obj(faces));
  scene.name = printable(path.stem());
  return scene;
}

Scene open_file(const std::string& spec, bool keep_instances) {
  const std::filesystem::path path = spec;
  const std::string extension = extension_of(path);
  if (is_mesh_file(path)) return load_mesh_file(path);
  if (extension == ".json") return load_scene_file(path, keep_instances);
  if (extension == ".anim") return open_anim(path);

  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(printable(path) + ": is a directory, not a scene file");
  }
  if (std::filesystem::exists(path, error)) {
    throw InputError(
        printable(path) + ": " +
        (extension.empty() ? "no extension" : "unknown extension '" + printable(path.extension()) + "'") +
        ", scene files end in .obj, .gltf, .glb, .ply, .json or .anim");
  }
  if (!extension.empty() || path.has_parent_path()) throw InputError(printable(path) + ": no such file");
  throw InputError("unknown scene '" + printable(std::string_view(spec)) +
                   "': neither a file nor a built-in scene (see 'coppice scenes')");
}

std::optional<Scene> find_generated(const std::string& spec) {
  if (const auto built_in = find_built_in(spec)) return built_in->make();
  const auto [name, count] = split(spec);
  if (name != "grove") return std::nullopt;
  if (count) throw InputError("scene 'grove' has one size, it takes no number of triangles");
  return make_grove();
}

}  // namespace

std::vector<SceneListing> list_scenes() {
  static const auto grove_triangles = static_cast<std::uint32_t>(make_grove().indices.size());
  return {
      {"grove", "a coppiced wood: stools, shoots, rocks and felled logs", grove_triangles, false},
      {"scatter", "clusters of unconnected triangles of all sizes, for benchmarks", SCATTER_DEFAULT, true},
      {"terrain", "one connected height field", TERRAIN_DEFAULT, true},
      {"moving", "waves, a twist, an explosion and a swarm, for animate", MOVING_DEFAULT, true},
      {"instances", "a swarm of N instances of three meshes: stones, ferns and boxes",
       static_cast<std::uint32_t>(swarm_triangles(INSTANCES_DEFAULT)), true}};
}

std::vector<SceneListing> list_hard_scenes() {
  std::vector<SceneListing> listings;
  for (const HardCase& hard_case : hard_cases()) {
    listings.push_back({"hard:" + std::string(hard_case.name), std::string(hard_case.description),
                        hard_case.triangle_count(hard_case.default_triangle_count), true});
  }
  return listings;
}

std::optional<SceneSize> built_in_size(const std::string& spec) {
  const auto built_in = find_built_in(spec);
  return built_in ? std::optional(built_in->size) : std::nullopt;
}

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".obj" || extension == ".gltf" || extension == ".glb" || extension == ".ply";
}

Scene load_mesh_file(const std::filesystem::path& path, const GltfReading& reading) {
  const std::string extension = extension_of(path);
  if (extension == ".ply") return load_ply(path);
  if (extension == ".obj") return load_obj(path);
  return load_gltf(path, reading);
}

Scene make_built_in(const std::string& spec) {
  if (auto scene = find_generated(spec)) return flattened(std::move(*scene));
  throw InputError("unknown scene '" + printable(std::string_view(spec)) +
                   "', expected a built-in one (see 'coppice scenes')");
}

Scene open_scene(const std::string& spec, std::string_view up, bool keep_instances) {
  std::optional<Scene> generated = find_generated(spec);
  Scene scene = generated ? std::move(*generated) : open_file(spec, keep_instances);
  if (!keep_instances) scene = flattened(std::move(scene));
  stand_up(scene, up);
  bring_into_range(scene);
  return scene;
}

void set_lens(Scene& scene, const SceneOptions& options) {
  const auto in_scene = [&](double length) {
    const double scaled = std::ldexp(length, scene.scale_exponent);
    return static_cast<float>(std::clamp(scaled, double{FLT_MIN}, double{FLT_MAX}));
  };
  Lens& lens = scene.lens;
  if (options.aperture) {
    lens.aperture = *options.aperture > 0 ? in_scene(*options.aperture) : 0.0f;
    lens.origin = "--aperture";
  }
  if (!options.focus) return;
  lens.focus = in_scene(*options.focus);
  if (lens.aperture == 0) scene.warnings.push_back("--focus means nothing without an aperture");
}

void set_environment(Scene& scene, const SceneOptions& options) {
  if (options.environment.empty()) return;
  Environment environment;
  environment.origin = "--environment";
  if (options.environment == "sky") {
    environment.sky = Sky{};
  } else {
    const std::filesystem::path path = options.environment;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      throw InputError("--environment: '" + printable(path) +
                       "' is no file, expected an HDR image (.hdr, .exr) or sky");
    environment.image = path.filename().string();
    environment.folder = path.parent_path().string();
  }
  scene.environment = environment;
}

}  // namespace coppice
