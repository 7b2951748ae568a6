#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interface/ploc.h"
#include "scene/effect_set.h"
#include "scene/load_gltf.h"
#include "scene/scene.h"

namespace coppice {

// The largest N that a generated scene may be asked for: what a build on the device takes (max_triangles).
inline constexpr std::uint32_t MAX_GENERATED_TRIANGLES = 65535u * PLOC_MERGE_TILE;

// A scene that open_scene knows by name.
struct SceneListing {
  std::string name;         // as open_scene takes it
  std::string description;  // one line
  std::uint32_t triangles;  // the number of triangles without ":N"
  // Whether ":N" may follow the name, of "instances" as their number, else N from 1 to
  // MAX_GENERATED_TRIANGLES. The scene then has N triangles, a closed hard case as many as
  // HardCase::triangle_count says.
  bool takes_count;
};

// The built-in scenes for looking at and for benchmarks, the default one first.
std::vector<SceneListing> list_scenes();

// The hard cases; ":N:SEED" may follow their names too.
std::vector<SceneListing> list_hard_scenes();

// What a built-in scene will hold, known before it is made.
struct SceneSize {
  std::uint64_t triangles, vertices;  // a hard case may have fewer vertices
  std::uint64_t instances = 0;        // where they are kept
};

// The size, instances flattened, of a built-in scene that takes a number of triangles; none for "grove", and
// for a file. Throws InputError where open_scene would, but for what is only found in files.
std::optional<SceneSize> built_in_size(const std::string& spec);

// Whether the name ends in .obj, .gltf, .glb or .ply, in any letter case; and the load_* of what it is.
bool is_mesh_file(const std::filesystem::path& path);
Scene load_mesh_file(const std::filesystem::path& path, const GltfReading& reading = {});

// A built-in scene by its name, neither stood up nor brought into range. Throws InputError as open_scene
// does.
Scene make_built_in(const std::string& spec);

// Opens what the user named: the path of a mesh (is_mesh_file), of a scene file (.json) or of an .anim file
// with the OBJ of its first frame beside it (x_f00.obj beside x.anim), "grove", "scatter[:N]", "terrain[:N]",
// "moving[:N]", "instances[:N]" or "hard:CASE[:N[:SEED]]", with SEED a decimal number below 2^64, 1 if not
// given. A built-in name wins over a file of the same name ("./grove" names the file). The scene is stood up
// (stand_up) and brought into range (bring_into_range). Throws InputError where nothing answers to the name,
// N or SEED is out of range, or the file cannot be loaded. Instances are flattened unless they are to be
// kept.
Scene open_scene(const std::string& spec, std::string_view up = "y", bool keep_instances = false);

// What names a scene.
struct SceneOptions {
  std::string spec = "grove";  // as open_scene takes it
  std::string up = "y";        // one of UP_AXES
  bool keep_instances = false;
  EffectChanges effects{};  // beside what it calls for
  // Of the lens, in the file's unit, in the place of what the scene says.
  std::optional<double> aperture{}, focus{};
  std::optional<std::uint32_t> bounces{};  // of paths at most; none: the scene's own
  std::string environment{};  // an image, or "sky" for the default one; empty: what the scene says
};

// Those two, of a scene that is open. Says in its warnings where the focus means nothing.
void set_lens(Scene& scene, const SceneOptions& options);

// The environment, likewise. Throws InputError where the image is no regular file.
void set_environment(Scene& scene, const SceneOptions& options);

}  // namespace coppice
