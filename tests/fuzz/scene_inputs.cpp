#include "fuzz/scene_inputs.h"

#include <functional>

#include "fuzz/scene_complaint.h"
#include "scene/generators.h"
#include "scene/input_error.h"
#include "scene/load_gltf.h"
#include "scene/load_ply.h"
#include "scene/motion.h"
#include "scene/scene_file.h"

namespace coppice {
namespace {

std::string complaint_about_read(const std::string& name, const std::function<Scene()>& read) {
  try {
    return complaint_about(read());
  } catch (const InputError& error) {
    const std::string message = error.what();
    return is_one_line(message) && message.starts_with(name) ? "" : "message '" + message + "'";
  } catch (const std::exception& error) {
    return std::string("exception ") + error.what();
  }
}

// Turns round and morphs.
class FuzzRig : public Rig {
 public:
  Pose pose(double seconds) const override {
    Pose pose;
    pose.joints.emplace_back(1.0f);
    pose.joints.emplace_back(static_cast<float>(seconds));
    pose.morph_weights = {static_cast<float>(seconds)};
    pose.camera = Camera{};
    return pose;
  }
};

Scene fuzz_mesh(const std::string& path) {
  if (path.starts_with("missing")) throw InputError("no such file");
  Scene scene = make_terrain(path.size() % 7 + 1);
  if (path.find("gl") == path.npos) return scene;
  Motion motion;
  motion.rest = scene.positions;
  const auto count = static_cast<std::uint32_t>(scene.positions.size());
  motion.morphs.push_back({{0, count}, 0, scene.positions});
  motion.joints.assign(count, {0, 1, 1, 0});
  motion.weights.assign(count, glm::vec4(0.5f, 0.25f, 0.25f, 0));
  motion.rig = std::make_shared<FuzzRig>();
  scene.positions = positions_at(motion, 0);
  scene.motion = std::make_shared<Motion>(motion);
  return scene;
}

}  // namespace

std::string complaint_about_gltf(std::string_view input) {
  const auto find = [](const std::string& uri) {
    if (uri != "b.bin") throw InputError("no such file");
    std::string bytes(256, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i % 3 == 0 ? i / 16 : 0);
    return bytes;
  };
  return complaint_about_read("fuzz.gltf", [&] { return parse_gltf(input, "fuzz.gltf", find); });
}

std::string complaint_about_scene_file(std::string_view input) {
  constexpr std::string_view separator = "\n===\n";
  const std::size_t end = input.find(separator);
  SceneFileSources sources;
  sources.mesh = [](const std::string& path, const GltfReading&) { return fuzz_mesh(path); };
  sources.built_in = fuzz_mesh;
  sources.bytes = [&](const std::string&) {
    return std::string(end == input.npos ? "" : input.substr(end + separator.size()));
  };
  return complaint_about_read("fuzz.json",
                              [&] { return parse_scene_file(input.substr(0, end), "fuzz.json", sources); });
}

std::string complaint_about_ply(std::string_view input) {
  return complaint_about_read("fuzz.ply", [&] { return parse_ply(input, "fuzz.ply"); });
}

}  // namespace coppice
