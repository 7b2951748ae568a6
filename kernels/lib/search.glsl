// What a walk looks for, and which primitives a ray sees; see TraceClosestArgs and TraceAnyArgs.
#ifndef COPPICE_LIB_SEARCH
#define COPPICE_LIB_SEARCH
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

// What a walk looks for. Its members are constants wherever a walk is called, so that what they leave out is not
// compiled.
struct Search {
  bool any;     // ends at the first opaque triangle that is hit; else goes on to the closest one
  bool masked;  // by the sight; else every triangle is seen
};

struct Sight {
  UintBuffer primitive_flags;  // null: PRIMITIVE_FLAGS_DEFAULT
  uint mask;                   // of the ray
};

uint mask_of(UintBuffer ray_masks, uint ray_mask, uint ray) {
  if (uint64_t(ray_masks) != 0ul) return ray_mask & ray_masks.at[ray];
  return ray_mask;
}

bool sees(Sight sight, uint primitive, bool only_opaque) {
  uint flags = PRIMITIVE_FLAGS_DEFAULT;
  if (uint64_t(sight.primitive_flags) != 0ul) flags = sight.primitive_flags.at[primitive];
  return (flags & sight.mask & PRIMITIVE_MASK) != 0u && !(only_opaque && (flags & PRIMITIVE_NOT_OPAQUE) != 0u);
}

#endif
