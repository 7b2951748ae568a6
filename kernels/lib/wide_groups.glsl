// Tiles and workgroups of a level of the wide tree.
#include "lib/wide_rows.glsl"

uint wide_tiles(uint count) { return (count + WIDE_TILE - 1u) / WIDE_TILE; }

WideLevel planned_level(uint first, uint count, uint first_tile, uint first_block) {
  return WideLevel(first, count, first_tile, first_block, wide_rows(wide_tiles(count)), 0u);
}
