// Transforms and placed instances read and written as words of 64 bits: devices that load a vector lane by lane take
// half as long. A row of either is two words.
#ifndef COPPICE_LIB_INSTANCE_WORDS
#define COPPICE_LIB_INSTANCE_WORDS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RowWordsBuffer { u64vec2 at[]; };

uvec4 load_row(RowWordsBuffer rows, uint i) {
  u64vec2 words = rows.at[i];
  return uvec4(unpackUint2x32(words.x), unpackUint2x32(words.y));
}

void store_row(RowWordsBuffer rows, uint i, uvec4 row) {
  rows.at[i] = u64vec2(packUint2x32(row.xy), packUint2x32(row.zw));
}

Transform load_transform(InstanceTransformBuffer transforms, uint i) {
  RowWordsBuffer rows = RowWordsBuffer(transforms);
  Transform by;
  [[unroll]] for (uint row = 0u; row < 3u; ++row)
    by.rows[row] = flushed_row(uintBitsToFloat(load_row(rows, 3u * i + row)));
  return by;
}

PlacedInstance load_placed(PlacedInstanceBuffer placed, uint i) {
  RowWordsBuffer rows = RowWordsBuffer(placed);
  vec4 x = uintBitsToFloat(load_row(rows, 4u * i)), y = uintBitsToFloat(load_row(rows, 4u * i + 1u));
  vec4 z = uintBitsToFloat(load_row(rows, 4u * i + 2u));
  uvec4 last = load_row(rows, 4u * i + 3u);
  return PlacedInstance(x.xyz, x.w, y.xyz, y.w, z.xyz, z.w, uintBitsToFloat(last.xyz), last.w);
}

void store_placed(PlacedInstanceBuffer placed, uint i, PlacedInstance p) {
  RowWordsBuffer rows = RowWordsBuffer(placed);
  store_row(rows, 4u * i, floatBitsToUint(vec4(p.row_x, p.room_x)));
  store_row(rows, 4u * i + 1u, floatBitsToUint(vec4(p.row_y, p.room_y)));
  store_row(rows, 4u * i + 2u, floatBitsToUint(vec4(p.row_z, p.room_z)));
  store_row(rows, 4u * i + 3u, uvec4(floatBitsToUint(p.pad), p.mesh));
}

#endif
