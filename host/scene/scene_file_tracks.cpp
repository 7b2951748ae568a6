#include "scene/scene_file_tracks.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/json_check.h"

namespace coppice {
namespace {

using nlohmann::json;

glm::dvec3 double_vector_of(const json& numbers) {
  return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

glm::dquat quaternion_of(const json& numbers, const std::string& name, const std::string& pointer) {
  const glm::dquat q(numbers[3].get<double>(), numbers[0].get<double>(), numbers[1].get<double>(),
                     numbers[2].get<double>());
  const double length = glm::length(q);
  if (!(length > 1e-12) || !std::isfinite(length))
    fail_at(name, pointer, shortened(numbers) + ", expected a quaternion that is not 0");
  return q / length;
}

void read_times(const json& track, Keyframes& keyframes, std::size_t value_count, const char* values,
                const std::string& name, const std::string& pointer) {
  keyframes.times = track["times"].get<std::vector<double>>();
  for (std::size_t i = 1; i < keyframes.times.size(); ++i) {
    if (keyframes.times[i] <= keyframes.times[i - 1]) {
      fail_at(name, pointer + "/times/" + std::to_string(i),
              shortened(track["times"][i]) + ", expected more than the time before");
    }
  }
  if (value_count != keyframes.times.size()) {
    fail_at(name, pointer + "/" + values,
            std::to_string(value_count) + " values, expected one for each of the " +
                std::to_string(keyframes.times.size()) + " times");
  }
}

// Once times and values are there.
void set_interpolation(const json& track, Keyframes& keyframes) {
  const std::string how = track.value("interpolation", "linear");
  if (how == "step") keyframes.interpolation = Interpolation::step;
  if (how == "cubic") smooth(keyframes);
}

Keyframes read_track(const json& track, std::uint32_t width, const std::string& name,
                     const std::string& pointer) {
  Keyframes keyframes;
  keyframes.width = width;
  for (const json& value : track["values"]) {
    if (width == 1) keyframes.values.push_back(value.get<double>());
    for (std::uint32_t c = 0; width > 1 && c < width; ++c) keyframes.values.push_back(value[c].get<double>());
  }
  read_times(track, keyframes, track["values"].size(), "values", name, pointer);
  set_interpolation(track, keyframes);
  return keyframes;
}

NodeTrack read_rotation_track(const json& track, const std::string& name, const std::string& pointer) {
  NodeTrack result;
  Keyframes& keyframes = result.keyframes;
  const bool is_turn = track.contains("axis") && track.contains("degrees");
  if (is_turn == track.contains("values") || track.contains("axis") != track.contains("degrees")) {
    fail_at(name, pointer, "expected either \"values\" or both \"axis\" and \"degrees\"");
  }
  if (is_turn) {
    result.path = NodePath::turn;
    result.axis = direction_of(track["axis"], name, pointer + "/axis");
    keyframes.width = 1;
    keyframes.values = track["degrees"].get<std::vector<double>>();
    read_times(track, keyframes, keyframes.values.size(), "degrees", name, pointer);
    set_interpolation(track, keyframes);
    return result;
  }
  result.path = NodePath::rotation;
  keyframes.width = 4;
  keyframes.is_rotation = true;
  glm::dquat before(1, 0, 0, 0);
  for (std::size_t i = 0; i < track["values"].size(); ++i) {
    glm::dquat q = quaternion_of(track["values"][i], name, pointer + "/values/" + std::to_string(i));
    if (glm::dot(q, before) < 0) q = -q;  // the shorter way, for cubic curves too
    keyframes.values.insert(keyframes.values.end(), {q.x, q.y, q.z, q.w});
    before = q;
  }
  read_times(track, keyframes, track["values"].size(), "values", name, pointer);
  set_interpolation(track, keyframes);
  return result;
}

}  // namespace

glm::vec3 vector_of(const json& numbers) { return glm::vec3(double_vector_of(numbers)); }

glm::dvec3 direction_of(const json& numbers, const std::string& name, const std::string& pointer) {
  const glm::dvec3 direction = double_vector_of(numbers);
  const double length = glm::length(direction);
  if (!(length > 1e-30) || !std::isfinite(length))
    fail_at(name, pointer, shortened(numbers) + ", expected a direction that is not 0");
  return direction / length;
}

NodeTransform read_transform(const json& object, const std::string& name, const std::string& pointer) {
  NodeTransform transform;
  if (object.contains("matrix")) {
    for (const char* const key : {"translation", "rotation", "scale", "keyframes"}) {
      if (object.contains(key)) fail_at(name, pointer + "/" + key, "does not go with \"matrix\"");
    }
    transform.is_matrix = true;
    const json& rows = object["matrix"];
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        transform.given[column][row] = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      }
    }
    if (rows[3] != json::array({0, 0, 0, 1}))
      fail_at(name, pointer + "/matrix/3", shortened(rows[3]) + ", expected [0,0,0,1]");
    return transform;
  }
  if (object.contains("translation")) transform.translation = double_vector_of(object["translation"]);
  if (object.contains("scale")) {
    const json& scale = object["scale"];
    transform.scale = scale.is_array() ? double_vector_of(scale) : glm::dvec3(scale.get<double>());
  }
  if (!object.contains("rotation")) return transform;
  const json& rotation = object["rotation"];
  if (rotation.is_array()) {
    transform.rotation = quaternion_of(rotation, name, pointer + "/rotation");
  } else {
    const glm::dvec3 axis = direction_of(rotation["axis"], name, pointer + "/rotation/axis");
    transform.rotation = glm::angleAxis(glm::radians(rotation["degrees"].get<double>()), axis);
  }
  return transform;
}

void read_object_tracks(const json& object, const std::string& name, const std::string& pointer,
                        std::uint32_t node, std::vector<NodeTrack>& tracks) {
  if (!object.contains("keyframes")) return;
  for (const auto& [key, track] : object["keyframes"].items()) {
    const std::string place = pointer + "/keyframes/" + key;
    NodeTrack read;
    if (key == "rotation") {
      read = read_rotation_track(track, name, place);
    } else {
      read.path = key == "scale" ? NodePath::scale : NodePath::translation;
      read.keyframes = read_track(track, 3, name, place);
    }
    read.node = node;
    tracks.push_back(std::move(read));
  }
}

CameraTracks read_scene_camera(const json& camera, const std::string& name, const std::string& pointer) {
  CameraTracks tracks;
  Camera& still = tracks.still;
  still.position = vector_of(camera["position"]);
  still.target = vector_of(camera["target"]);
  if (camera.contains("up")) still.up = glm::vec3(direction_of(camera["up"], name, pointer + "/up"));
  still.vertical_fov_degrees = camera.value("fov", still.vertical_fov_degrees);
  const json keyframes = camera.value("keyframes", json::object());
  const auto read = [&](const char* key, std::uint32_t width, std::optional<Keyframes>& track) {
    if (keyframes.contains(key))
      track = read_track(keyframes[key], width, name, pointer + "/keyframes/" + key);
  };
  read("position", 3, tracks.position);
  read("target", 3, tracks.target);
  read("up", 3, tracks.up);
  read("fov", 1, tracks.fov);
  for (int i = 0; i <= 256; ++i) {  // a look at the curves, between keys as well
    double end = 0;
    for (const auto* track : {&tracks.position, &tracks.target, &tracks.up}) {
      if (*track) end = std::max(end, (*track)->times.back());
    }
    const double seconds = end * i / 256;
    const Camera at = tracks.at(seconds);
    const glm::dvec3 sight = glm::dvec3(at.target) - glm::dvec3(at.position);
    if (!(glm::length(sight) > 0) || !(glm::length(glm::cross(sight, glm::dvec3(at.up))) > 0)) {
      fail_at(name, pointer,
              "at " + std::to_string(seconds) +
                  " seconds the position is the target, or up points "
                  "along the line of sight; expected a direction");
    }
    if (!tracks.moves()) break;
  }
  return tracks;
}

Lens read_scene_lens(const json& camera) {
  return {camera.value("aperture", 0.0f), camera.value("focus", 0.0f), "/camera/aperture"};
}

}  // namespace coppice
