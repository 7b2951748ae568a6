layout(constant_id = DEVICE_LANES_IN_STEP_ID) const bool LANES_IN_STEP = false;

// All reads of the subgroup behind see all writes to shared memory before. Lanes in step need nothing; even a fence would
// cost CPU devices as much as ten loads.
void sync() {
  if (!LANES_IN_STEP) subgroupBarrier();
}
