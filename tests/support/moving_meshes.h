#pragma once

#include "scene/instances.h"
#include "scene/scene_compose.h"
#include "scene/scene_source.h"
#include "support/moving_scenes.h"

namespace coppice {

// Nodes: 0 stands still, 1 goes along x and turns, 2 hangs from it, 3 mirrors, 4 stands still elsewhere.
inline GltfRig nodes_that_move() {
  GltfRig rig;
  rig.nodes.resize(5);
  rig.nodes[0].translation = {-6, 0.5, 0};
  rig.nodes[2].translation = {0, 5, 1};
  rig.nodes[2].scale = {0.5, 0.7, 0.9};
  rig.nodes[3].translation = {5, -4, 2};
  rig.nodes[3].scale = {-1, 1, 0.5};
  rig.nodes[4].translation = {1, -6, -3};
  rig.parents = {-1, -1, 1, -1, 3};
  rig.order = {0, 1, 3, 2, 4};
  Keyframes way;
  way.times = {0, 2};
  way.values = {3, 0, 0, -3, 2, 1};
  rig.tracks.push_back({1, NodePath::translation, way});
  Keyframes turn;
  turn.width = 1;
  turn.times = {0, 1};
  turn.values = {10, 120};
  rig.tracks.push_back({1, NodePath::turn, turn, {0, 0.6, 0.8}});
  return rig;
}

// Instances of a mesh that deforms every way there is, of one in waves and of one that stands still; some of
// them are moved by keyframes, and one between these is not.
inline InstanceComposition meshes_that_move(std::uint32_t part_triangles) {
  InstanceComposition composition;
  composition.nodes = nodes_that_move();
  composition.meshes = {make_built_in("hard:sphere:150"), all_that_moves(part_triangles),
                        make_built_in("terrain:200")};
  Scene& ground = composition.meshes[2];
  Motion waves = motion_of(ground);
  waves.deformations.push_back({.vertices = {0, static_cast<std::uint32_t>(ground.positions.size())},
                                .size = 10,
                                .amount = 0.2f,
                                .seconds = 3});
  ground.motion = std::make_shared<Motion>(waves);
  composition.placed = {{0, 0}, {1, 1}, {0, 3}, {0, 2}, {1, 4}, {2, 0}, {1, 3}};
  return composition;
}

inline Scene scene_of_moving_meshes(std::uint32_t part_triangles) {
  Scene scene = compose_instances(meshes_that_move(part_triangles));
  scene.camera = Camera{.position = {4, 6, 30}};
  return scene;
}

}  // namespace coppice
