// A count that only the device knows.
#ifndef COPPICE_LIB_DEVICE_COUNT
#define COPPICE_LIB_DEVICE_COUNT
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

// At most `most`, which is the count where there is no address.
uint counted(UintBuffer at, uint most) { return uint64_t(at) == 0ul ? most : min(at.at[0], most); }

#endif
