// Adds a subgroup's count to a 64-bit sum of two words. Partners: all subgroups of all traces of the frame.
#ifndef COPPICE_LIB_TRACE_COUNTERS
#define COPPICE_LIB_TRACE_COUNTERS
#define COUNT_INTO(counter, value)                            \
  {                                                           \
    uint subgroup_sum = subgroupAdd(value);                   \
    if (subgroupElect()) {                                    \
      uint low = atomicAdd(counter.x, subgroup_sum);          \
      if (low + subgroup_sum < low) atomicAdd(counter.y, 1u); \
    }                                                         \
  }

#endif
