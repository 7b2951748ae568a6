// A subgroup as one: how wide it is, its order, and what its invocations know of each other.
#ifndef COPPICE_LIB_SUBGROUP
#define COPPICE_LIB_SUBGROUP
#extension GL_KHR_shader_subgroup_shuffle : require

layout(constant_id = DEVICE_SUBGROUP_SIZE_ID) const uint LANES = 8u;
layout(constant_id = DEVICE_LANES_IN_STEP_ID) const bool LANES_IN_STEP = false;

uint lane() { return gl_SubgroupInvocationID; }

// All reads of the subgroup behind see all writes to shared memory before. Lanes in step need nothing, as
// no compiler moves an access over a store to a place that it cannot tell apart; even a fence would cost CPU devices as
// much as ten loads.
void sync() {
  if (!LANES_IN_STEP) subgroupBarrier();
}

// The same of coherent device memory.
void sync_memory() {
  if (!LANES_IN_STEP) {
    memoryBarrierBuffer();
    subgroupBarrier();
  }
}

// subgroupInclusiveAdd goes lane by lane on CPU devices.
uint inclusive_add(uint value) {
  [[unroll]] for (uint distance = 1u; distance < LANES; distance <<= 1) {
    uint before = subgroupShuffle(value, (lane() - distance) % LANES);
    value += lane() >= distance ? before : 0u;
  }
  return value;
}

#endif
