// Tiles and workgroups of a level of the wide tree.

uint wide_tiles(uint count) { return (count + WIDE_TILE - 1u) / WIDE_TILE; }

// As many workgroups, or a few more: a row takes 65,535.
uvec3 wide_rows(uint groups) {
  uint rows = (groups + 65534u) / 65535u;
  return rows == 0u ? uvec3(0u) : uvec3((groups + rows - 1u) / rows, rows, 1u);
}

uint wide_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

WideLevel planned_level(uint first, uint count, uint first_tile, uint first_block) {
  return WideLevel(first, count, first_tile, first_block, wide_rows(wide_tiles(count)), 0u);
}
