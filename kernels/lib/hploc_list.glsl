// The clusters that one subgroup has in shared memory, and lists of them.
//
// A cluster has a slot, which holds its node, and a name, the first place that it took. Of two that merge the first
// keeps slot and name, and the name j of the other, never 0, gives the pair its place: 2j - 1 and 2j.
#include "lib/node_words.glsl"
#include "lib/subgroup.glsl"

shared u64vec4 cluster_words[HPLOC_TILE];  // nodes by slot
shared uint names[HPLOC_LIST];             // by slot, of clusters from memory
shared uint list[HPLOC_TILE];              // slots
shared uint nearest[HPLOC_TILE];           // of a list: slots and, 16 bits higher, indices of nearest neighbours
shared uint pairs[HPLOC_TILE / 2u];        // the lower slot, and 16 bits higher the upper one

// Clusters side by side in `list`. Slots are places behind first_place; clusters from memory have names.
struct List {
  uint base, count;
  uint first_place;
  bool from_memory;
};

uint name_of(uint slot, List its) { return its.from_memory ? names[slot % HPLOC_LIST] : its.first_place + slot; }

void join_pairs(uint pair_count, List its) {
  [[dont_unroll]] for (uint i = lane(); i < pair_count; i += LANES) {
    uint left = pairs[i] & 0xffffu, right = pairs[i] >> 16;
    u64vec4 left_words = cluster_words[left], right_words = cluster_words[right];
    uint first_child = 2u * name_of(right, its) - 1u;
    NodeWordsBuffer(args.nodes).at[first_child] = left_words;
    NodeWordsBuffer(args.nodes).at[first_child + 1u] = right_words;
    cluster_words[left] = words_of(parent_of(node_of(left_words), node_of(right_words), first_child));
  }
}
