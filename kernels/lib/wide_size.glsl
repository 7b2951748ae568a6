// The size of the subtree of a wide node, and how far behind it its children come in depth-first order.
void measure(uint index) {
  WideEntry entry = args.entries.at[index];
  uint size = 1u;
  [[dont_unroll]] for (uint c = 0u; c < entry.child_count; ++c) {
    args.offsets.at[entry.first_child + c] = size;
    size += args.sizes.at[entry.first_child + c];
  }
  args.sizes.at[index] = size;
}
