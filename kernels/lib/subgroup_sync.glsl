layout(constant_id = DEVICE_LANES_IN_STEP_ID) const bool LANES_IN_STEP = false;

// All reads of the subgroup behind see all writes to shared memory before. A barrier costs CPU devices as much as twenty
// loads.
void sync() {
  if (LANES_IN_STEP) memoryBarrierShared();
  else subgroupBarrier();
}
