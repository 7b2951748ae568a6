#pragma once

#include "pipeline/check_chain.h"

namespace coppice {

// What moves vertices, each stage by itself and every deformation.
void add_vertex_check(CheckChain& chain);

// Two levels of instances that move: transforms, boxes, the tree over them, rays, and the hits in their
// place. Of the meshes' trees and the stages of a build nothing is said that a build does not say.
void add_instance_check(CheckChain& chain, const BuildOptions& options, std::uint32_t max_turns);

}  // namespace coppice
