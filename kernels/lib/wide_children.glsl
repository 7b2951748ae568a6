// A wide node as a subgroup holds it: an invocation a child, or several where there are fewer than eight invocations.

const uint SLOTS = LANES < WIDE_CHILDREN ? WIDE_CHILDREN / LANES : 1u;

struct WideChildren {
  vec3 origin;
  float size;  // no child's corner is farther from the origin, in the maximum norm
  vec3 box_min[SLOTS], box_max[SLOTS];
  uint word[SLOTS];
};

// The child that this invocation holds.
uint held_child(uint slot) { return (lane() + slot * LANES) & (WIDE_CHILDREN - 1u); }

// What the invocation that holds the child has.
uint of_child(uint x[SLOTS], uint child) {
  uint result = subgroupShuffle(x[0], child & (LANES - 1u));
  [[unroll]] for (uint slot = 1u; slot < SLOTS; ++slot) {
    uint other = subgroupShuffle(x[slot], child & (LANES - 1u));
    result = child >= slot * LANES ? other : result;
  }
  return result;
}

vec3 of_child(vec3 x[SLOTS], uint child) {
  vec3 result;
  [[unroll]] for (uint axis = 0u; axis < 3u; ++axis) {
    uint bits[SLOTS];
    [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) bits[slot] = floatBitsToUint(x[slot][axis]);
    result[axis] = uintBitsToFloat(of_child(bits, child));
  }
  return result;
}

uint read_child_word(uint node, uint slot) { return args.wide_nodes.at[node].child[held_child(slot)]; }

void read_children(uint node, out WideChildren children) {
  UintBuffer words = UintBuffer(args.wide_nodes);
  uint first = node * WIDE_NODE_WORDS;
  uint header = words.at[first + (lane() & 3u)];
  vec3 origin = uintBitsToFloat(
      uvec3(subgroupBroadcast(header, 0u), subgroupBroadcast(header, 1u), subgroupBroadcast(header, 2u)));
  uint exponents = subgroupBroadcast(header, 3u);
  vec3 step = uintBitsToFloat((uvec3(exponents, exponents >> 8, exponents >> 16) & 0xffu) << 23);
  children.origin = origin;
  children.size = greater(greater(step.x, step.y), step.z) * WIDE_NODE_STEPS;
  [[unroll]] for (uint slot = 0u; slot < SLOTS; ++slot) {
    uint child = held_child(slot);
    // Six bytes a child, so an odd one begins in the middle of a word.
    uint at = first + 4u + ((child * 3u) >> 1);
    uint low = words.at[at], high = words.at[at + 1u];
    bool odd = (child & 1u) != 0u;
    uint to_max_x = odd ? low >> 16 | high << 16 : low;
    uint from_max_y = odd ? high >> 16 : high;
    uvec3 q_min = uvec3(to_max_x, to_max_x >> 8, to_max_x >> 16) & 0xffu;
    uvec3 q_max = uvec3(to_max_x >> 24, from_max_y & 0xffu, (from_max_y >> 8) & 0xffu);
    precise vec3 box_min = origin + vec3(q_min) * step;
    precise vec3 box_max = origin + vec3(q_max) * step;
    children.box_min[slot] = box_min;
    children.box_max[slot] = box_max;
    children.word[slot] = read_child_word(node, slot);
  }
}
