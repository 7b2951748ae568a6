// Triangles among which some may be in no leaf: none where the tree has all. The including kernel has `args`.
uint absent_limit() {
  uint count = min(args.state.at[0].primitive_count, args.triangle_count);
  return args.state.at[0].active_count < count ? count : 0u;
}
