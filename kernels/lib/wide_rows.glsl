// Dispatches in rows, where one row may not be enough.
#ifndef COPPICE_LIB_WIDE_ROWS
#define COPPICE_LIB_WIDE_ROWS

// As many workgroups, or a few more: a row takes 65,535.
uvec3 wide_rows(uint groups) {
  uint rows = (groups + 65534u) / 65535u;
  return rows == 0u ? uvec3(0u) : uvec3((groups + rows - 1u) / rows, rows, 1u);
}

uint wide_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

#endif
