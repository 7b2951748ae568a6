// Nodes and boxes read and written as words of 64 bits: devices that load a vector lane by lane take half as long.
#ifndef COPPICE_LIB_NODE_WORDS
#define COPPICE_LIB_NODE_WORDS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer NodeWordsBuffer {
  u64vec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer BoxWordsBuffer {
  u64vec3 at[];
};

Node node_of(u64vec4 words) {
  uvec2 a = unpackUint2x32(words.x), b = unpackUint2x32(words.y);
  uvec2 c = unpackUint2x32(words.z), d = unpackUint2x32(words.w);
  return Node(uintBitsToFloat(uvec3(a, b.x)), b.y, uintBitsToFloat(uvec3(c, d.x)), d.y);
}

u64vec4 words_of(Node node) {
  uvec3 low = floatBitsToUint(node.box_min), high = floatBitsToUint(node.box_max);
  return u64vec4(packUint2x32(low.xy), packUint2x32(uvec2(low.z, node.child)), packUint2x32(high.xy),
                 packUint2x32(uvec2(high.z, node.height)));
}

Node load_node(NodeBuffer nodes, uint i) { return node_of(NodeWordsBuffer(nodes).at[i]); }
void store_node(NodeBuffer nodes, uint i, Node node) { NodeWordsBuffer(nodes).at[i] = words_of(node); }

Aabb load_box(AabbBuffer boxes, uint i) {
  u64vec3 words = BoxWordsBuffer(boxes).at[i];
  uvec2 a = unpackUint2x32(words.x), b = unpackUint2x32(words.y), c = unpackUint2x32(words.z);
  return Aabb(uintBitsToFloat(uvec3(a, b.x)), uintBitsToFloat(uvec3(b.y, c)));
}

void store_box(AabbBuffer boxes, uint i, Aabb box) {
  uvec3 low = floatBitsToUint(box.box_min), high = floatBitsToUint(box.box_max);
  BoxWordsBuffer(boxes).at[i] =
      u64vec3(packUint2x32(low.xy), packUint2x32(uvec2(low.z, high.x)), packUint2x32(high.yz));
}

#endif
