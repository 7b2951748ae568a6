#pragma once

#include <cstdint>

#include "interface/instances.h"
#include "scene/scene.h"

namespace coppice {

// A transform of a scene as the stages take it.
InstanceTransform rows_of(const glm::mat4x3& transform);

// The part of a cycle at that time, in parts of 2^32: what the stage takes.
std::uint32_t turn_at(const Swarm& swarm, double seconds);

// How many triangles all instances have together.
std::uint64_t instanced_triangles(const Scene& scene);

// The scene with every instance's triangles in their place, instance after instance, and no instances:
// corners are rounded as on the device (docs/numerics.md, "Instances"), so a hit is the same one here and
// there. They stand still from then on, as they are at second 0; the camera too. A scene without instances as
// it is. Throws InputError for more triangles than 32 bits count.
Scene flattened(Scene scene);

// The scene as it stands at that time, by the host: instances that keyframes move and vertices of meshes that
// deform. A swarm rests.
Scene standing_at(const Scene& scene, double seconds);

// "instances:N": a swarm of so many instances of three meshes, stones, ferns and boxes, turned, scaled and
// every other one mirrored, on their way around the axis y. They stand about as close however many there are.
Scene make_instances(std::uint32_t instance_count);

// How many triangles they have together.
std::uint64_t swarm_triangles(std::uint32_t instance_count);

// A scene that fills the same room: of each instance the box of its mesh's active triangles, in its place, as
// triangles between its corners.
Scene boxes_of_instances(const Scene& scene);

}  // namespace coppice
