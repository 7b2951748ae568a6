// What host code and kernels both read: this folder is compiled by g++ and by glslang.
// Args say what their stages do with memory: READS(Buffer) is only read, by whichever stage has these Args; a
// Buffer may be written. Steps that write nothing that another reads or writes may overlap
// (stages/hazards.h). Every struct is padded to its alignment by hand, since scalar layout does not pad
// nested structs and C++ does.
#ifndef COPPICE_INTERFACE_TYPES_H
#define COPPICE_INTERFACE_TYPES_H

#ifdef __cplusplus

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <type_traits>

#define INTERFACE_BEGIN namespace coppice {
#define INTERFACE_END }
// A typed address: of device memory when a kernel reads it, of host memory when its twin does.
#define INTERFACE_BUFFER(Name, Type, Alignment) using Name = Address<Type>;
#define INTERFACE_COHERENT_BUFFER(Name, Type, Alignment) using Name = Address<Type>;
#define READS(Name) Name::ReadOnly

namespace coppice {
using uint = std::uint32_t;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;

template <class T>
struct Address {
  using ReadOnly = Address<const T>;

  std::uint64_t value = 0;

  // Only for addresses of host memory, so only in twins.
  T& operator[](std::size_t index) const { return reinterpret_cast<T*>(value)[index]; }

  operator ReadOnly() const requires(!std::is_const_v<T>) { return {value}; }
};
}  // namespace coppice

#else

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require

#extension GL_EXT_spirv_intrinsics : require

// RoundingModeRTE and SignedZeroInfNanPreserve for 32 bits: Vulkan promises neither without being asked.
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4467], 4462, 32);
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4466], 4461, 32);

#define INTERFACE_BEGIN
#define INTERFACE_END
// glslang does not hold a reference to `readonly`: the lockstep does, as the twin has a const address there.
#define READS(Name) Name
#define INTERFACE_BUFFER(Name, Type, Alignment) \
  layout(buffer_reference, scalar, buffer_reference_align = Alignment) buffer Name { Type at[]; };
// For words that other workgroups write while this one reads them. Old lavapipe hoists plain polls out of
// their loop and miscompiles the Vulkan memory model, but reads `volatile coherent` words afresh.
#define INTERFACE_COHERENT_BUFFER(Name, Type, Alignment)                                               \
  layout(buffer_reference, scalar, buffer_reference_align = Alignment) volatile coherent buffer Name { \
    Type at[];                                                                                         \
  };

#endif

INTERFACE_BEGIN

// A triangle by its corners, in world units.
struct Triangle {
  vec3 a, b, c;
};

struct Aabb {
  vec3 box_min, box_max;
};

// One entry of a BVH2, and one cluster while the tree grows. Root at 0; the two children of an internal node
// are neighbours in memory, so one 64-byte read fetches both boxes.
struct Node {
  vec3 box_min;
  uint child;  // leaf: triangle index; internal node: index of its first child, the second follows it
  vec3 box_max;
  uint height;  // 0 for a leaf, else 1 + the larger height of the children
};

// Specialization constants that every kernel may declare: what the device is. No result depends on them.
const uint DEVICE_SUBGROUP_SIZE_ID = 30;
// 1 where the invocations of a subgroup are the lanes of one vector (CPU devices): what one has written to
// shared or device memory the next instruction of all of them reads.
const uint DEVICE_LANES_IN_STEP_ID = 31;

INTERFACE_BUFFER(UintBuffer, uint, 4)
INTERFACE_BUFFER(FloatBuffer, float, 4)
INTERFACE_COHERENT_BUFFER(CoherentUintBuffer, uint, 4)
INTERFACE_BUFFER(TriangleBuffer, Triangle, 4)
INTERFACE_BUFFER(AabbBuffer, Aabb, 8)
INTERFACE_BUFFER(NodeBuffer, Node, 16)
INTERFACE_COHERENT_BUFFER(CoherentNodeBuffer, Node, 16)

// Bits of the error word: a kernel that cannot go on sets its bit, the host names the stage
// (stages/errors.h).
const uint ERROR_SORT_LOOKBACK = 1u;
const uint ERROR_PLOC_LOOKBACK = 2u;
const uint ERROR_PLOC_ROUNDS = 4u;
const uint ERROR_TREE_TOO_DEEP = 8u;
const uint ERROR_TRACE_STEPS = 16u;
const uint ERROR_SCAN_LOOKBACK = 32u;
const uint ERROR_WIDE_TOO_DEEP = 64u;
const uint ERROR_COUNT = 128u;
const uint ERROR_BATCH_RANGE = 256u;
const uint ERROR_RAY_COUNT = 512u;
const uint ERROR_REFIT_TOO_DEEP = 1024u;

// What the build knows of itself. Zero at the start of a build.
struct BuildState {
  uvec3 box_min_complement;  // ~ordered(x), so that a maximum over zero-initialised words finds the minimum
  uint active_count;         // primitives in the tree
  uvec3 box_max;             // ordered(x), see lib/ordered_float.glsl
  uint round_count;          // PLOC rounds it took
  uint error_word;
  uint primitive_count;  // asked for, active or not; more than the build was planned for are an error
  uint padding0, padding1;
};

INTERFACE_BUFFER(BuildStateBuffer, BuildState, 16)

INTERFACE_END

#endif
