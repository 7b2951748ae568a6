#include "scene/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/printable.h"

namespace coppice {
namespace {

using AnimatedPath = std::pair<int, std::string>;  // node, path

// The index of each channel in the file: tinygltf leaves out those without a node.
std::vector<std::size_t> channel_indices(const GltfDocument& document, std::size_t animation) {
  std::vector<std::size_t> indices;
  const nlohmann::json& channels = document.json["animations"][animation]["channels"];
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i]["target"].contains("node")) indices.push_back(i);
  }
  return indices;
}

bool is_path(const std::string& path) {
  return path == "translation" || path == "rotation" || path == "scale" || path == "weights";
}

// Of an animation, and only what is known.
std::set<AnimatedPath> targets_of(const GltfDocument& document, std::size_t index, SceneNotes& notes) {
  const tinygltf::Animation& animation = document.model.animations[index];
  const std::vector<std::size_t> indices = channel_indices(document, index);
  std::set<AnimatedPath> targets;
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    const tinygltf::AnimationChannel& channel = animation.channels[i];
    const std::string pointer =
        "/animations/" + std::to_string(index) + "/channels/" + std::to_string(indices[i]) + "/target";
    if (!is_path(channel.target_path)) {
      notes.add(pointer + "/path",
                "animation of '" + printable(std::string_view(channel.target_path)) + "' is not played");
      continue;
    }
    document.check_index(pointer + "/node", channel.target_node, document.model.nodes.size(), "nodes");
    if (!targets.insert({channel.target_node, channel.target_path}).second) {
      document.fail(pointer, "node " + std::to_string(channel.target_node) + "'s " + channel.target_path +
                                 " again, expected one channel for it");
    }
  }
  return targets;
}

std::vector<double> times_of(const GltfDocument& document, const GltfAccessors& accessors, int input,
                             const std::string& pointer) {
  const std::vector<float> floats = accessors.floats(input, "SCALAR", pointer);
  double before = -1;
  for (std::size_t i = 0; i < floats.size(); ++i) {
    if (!(floats[i] > before) || !std::isfinite(floats[i]) || floats[i] < 0) {
      document.fail("/accessors/" + std::to_string(input),
                    "time " + std::to_string(i) + " is " + std::to_string(floats[i]) +
                        ", expected rising times of at least 0 for " + pointer);
    }
    before = floats[i];
  }
  return {floats.begin(), floats.end()};
}

NodeTrack track_of(const GltfDocument& document, const GltfAccessors& accessors, std::size_t index,
                   const tinygltf::AnimationChannel& channel, const std::string& pointer) {
  const tinygltf::Animation& animation = document.model.animations[index];
  document.check_index(pointer + "/sampler", channel.sampler, animation.samplers.size(),
                       "samplers of the animation");
  const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
  const std::string sampler_pointer =
      "/animations/" + std::to_string(index) + "/samplers/" + std::to_string(channel.sampler);
  NodeTrack track;
  track.node = static_cast<std::uint32_t>(channel.target_node);
  const tinygltf::Node& node = document.model.nodes[track.node];
  const char* type = "VEC3";
  Keyframes& keyframes = track.keyframes;
  if (channel.target_path == "translation") track.path = NodePath::translation;
  if (channel.target_path == "scale") track.path = NodePath::scale;
  if (channel.target_path == "rotation") {
    track.path = NodePath::rotation;
    keyframes.is_rotation = true;
    keyframes.width = 4;
    type = "VEC4";
  }
  if (channel.target_path == "weights") {
    track.path = NodePath::weights;
    keyframes.width = static_cast<std::uint32_t>(target_count(document, track.node));
    if (keyframes.width == 0) {
      document.fail(pointer + "/target", "node " + std::to_string(track.node) +
                                             " has no morph targets, expected some for its weights");
    }
    type = "SCALAR";
  } else if (!node.matrix.empty()) {
    document.fail("/nodes/" + std::to_string(track.node) + "/matrix",
                  "expected translation, rotation and scale, for " + pointer + " moves the node");
  }
  const std::string& how = sampler.interpolation;
  keyframes.interpolation = how == "STEP"          ? Interpolation::step
                            : how == "CUBICSPLINE" ? Interpolation::cubic
                                                   : Interpolation::linear;
  keyframes.times = times_of(document, accessors, sampler.input, sampler_pointer + "/input");
  const std::vector<float> values = accessors.floats(sampler.output, type, sampler_pointer + "/output");
  const std::size_t parts = keyframes.interpolation == Interpolation::cubic ? 3 : 1;
  const std::size_t wanted = keyframes.times.size() * parts * keyframes.width;
  if (values.size() != wanted) {
    document.fail("/accessors/" + std::to_string(sampler.output) + "/count",
                  std::to_string(values.size()) + " numbers, expected " + std::to_string(wanted) +
                      " for the " + std::to_string(keyframes.times.size()) + " times of " + sampler_pointer);
  }
  keyframes.values.assign(values.begin(), values.end());
  return track;
}

std::string animation_name(const GltfDocument& document, std::size_t index) {
  const std::string& name = document.model.animations[index].name;
  return name.empty() ? std::to_string(index) : "'" + printable(std::string_view(name)) + "'";
}

std::size_t find_animation(const GltfDocument& document, const std::string& wanted) {
  const std::vector<tinygltf::Animation>& animations = document.model.animations;
  std::string known;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (animations[i].name == wanted) return i;
    known += (i == 0 ? "" : ", ") + animation_name(document, i);
  }
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (std::to_string(i) == wanted) return i;
  }
  document.fail("/animations", "no animation '" + printable(std::string_view(wanted)) +
                                   "', there are: " + (known.empty() ? "none" : known.substr(0, 300)));
}

}  // namespace

std::size_t target_count(const GltfDocument& document, std::size_t node) {
  const int mesh = document.model.nodes[node].mesh;
  if (mesh < 0) return 0;
  document.check_index("/nodes/" + std::to_string(node) + "/mesh", mesh, document.model.meshes.size(),
                       "meshes");
  const auto& primitives = document.model.meshes[static_cast<std::size_t>(mesh)].primitives;
  for (std::size_t i = 1; i < primitives.size(); ++i) {
    if (primitives[i].targets.size() == primitives[0].targets.size()) continue;
    document.fail("/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(i) + "/targets",
                  std::to_string(primitives[i].targets.size()) +
                      " morph targets, expected as many as in primitive 0, " +
                      std::to_string(primitives[0].targets.size()));
  }
  return primitives.empty() ? 0 : primitives[0].targets.size();
}

std::vector<NodeTrack> read_gltf_tracks(const GltfDocument& document, const GltfAccessors& accessors,
                                        const std::optional<std::string>& wanted, SceneNotes& notes) {
  const std::vector<tinygltf::Animation>& animations = document.model.animations;
  std::size_t first = 0, end = animations.size();
  if (wanted) {
    first = find_animation(document, *wanted);
    end = first + 1;
  }
  std::vector<NodeTrack> tracks;
  std::set<AnimatedPath> moved;
  for (std::size_t index = first; index < end; ++index) {
    const std::set<AnimatedPath> targets = targets_of(document, index, notes);
    const auto is_moved = [&](const AnimatedPath& target) { return moved.contains(target); };
    if (std::any_of(targets.begin(), targets.end(), is_moved)) {
      notes.add("/animations/" + std::to_string(index),
                "animation moves what an earlier one moves and is not played; a scene file can choose it");
      continue;
    }
    moved.insert(targets.begin(), targets.end());
    const std::vector<std::size_t> indices = channel_indices(document, index);
    const auto& channels = animations[index].channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!is_path(channels[i].target_path)) continue;
      const std::string pointer =
          "/animations/" + std::to_string(index) + "/channels/" + std::to_string(indices[i]);
      tracks.push_back(track_of(document, accessors, index, channels[i], pointer));
    }
  }
  return tracks;
}

}  // namespace coppice
