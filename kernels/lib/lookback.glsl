// Decoupled lookback over tiles that carry LOOKBACK_SUMS sums each: Merrill and Garland 2016, "Single-pass Parallel
// Prefix Scan with Decoupled Look-back". Vulkan promises no progress between workgroups, so a tile polls its
// predecessor a bounded number of times and then sums it up itself (Smith, Levien and Owens 2025, "Decoupled Fallback").
//
// The including kernel defines LOOKBACK_GROUP, LOOKBACK_SUMS and `void sum_tile(uint tile)`, by which the whole
// workgroup writes the sums of any tile to `tile_sums`.
//
// A status word is zero, or a flag and a 30-bit sum; it only ever goes from zero to aggregate to inclusive prefix, so
// each word is its own message and needs no fence.

const uint LOOKBACK_AGGREGATE = 0x40000000u;
const uint LOOKBACK_INCLUSIVE = 0x80000000u;
const uint LOOKBACK_VALUE = 0x3fffffffu;
const uint LOOKBACK_POLLS = 16u;       // unrolled, so that old lavapipe's loop limit counts them as one
const uint LOOKBACK_MAX_FALLBACKS = 64u;

layout(constant_id = 0) const uint LOOKBACK_TURNS = 16u;  // of LOOKBACK_POLLS each

shared uint tile_sums[LOOKBACK_SUMS];
shared uint lookback_own[LOOKBACK_SUMS];
shared uint lookback_prefix[LOOKBACK_SUMS];  // the result: sums over all tiles before this one
shared uint lookback_vote;

bool any_in_workgroup(bool vote) {
  if (gl_LocalInvocationIndex == 0u) lookback_vote = 0u;
  barrier();
  if (vote) atomicOr(lookback_vote, 1u);  // partners: this workgroup
  barrier();
  bool any_vote = lookback_vote != 0u;
  barrier();
  return any_vote;
}

uint poll(CoherentUintBuffer status, uint word_index, uint turns) {
  uint word = status.at[word_index];
  [[dont_unroll]] for (uint turn = 0u; turn < turns && word == 0u; ++turn) {
    [[unroll]] for (uint k = 0u; k < LOOKBACK_POLLS; ++k) {
      if (word == 0u) word = status.at[word_index];
    }
  }
  return word;
}

// Whole workgroup, with the tile's own sums in tile_sums. Returns the number of tiles it had to sum up itself, which
// overwrites tile_sums; more than LOOKBACK_MAX_FALLBACKS means that it gave up.
uint lookback(CoherentUintBuffer status, uint tile) {
  uint lane = gl_LocalInvocationIndex;
  uint first_flag = tile == 0u ? LOOKBACK_INCLUSIVE : LOOKBACK_AGGREGATE;
  [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
    uint own = tile_sums[v];
    status.at[tile * LOOKBACK_SUMS + v] = first_flag | own;
    lookback_own[v] = own;
    lookback_prefix[v] = 0u;
  }

  uint fallbacks = 0u;
  uint closed = 0u;  // bit k: the lane's k-th sum has met an inclusive prefix
  bool open = true;
  [[dont_unroll]] for (uint p = tile; p > 0u && open; --p) {
    uint base = (p - 1u) * LOOKBACK_SUMS;
    uint turns = LOOKBACK_TURNS;
    bool missing = false;
    uint bit = 1u;
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP, bit <<= 1) {
      if ((closed & bit) == 0u && poll(status, base + v, turns) == 0u) {
        missing = true;
        turns = 0u;
      }
    }
    if (any_in_workgroup(missing)) {
      if (++fallbacks > LOOKBACK_MAX_FALLBACKS) return fallbacks;
      sum_tile(p - 1u);
      [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
        // Partner: the tile's own workgroup, whose words are never replaced.
        atomicCompSwap(status.at[base + v], 0u, LOOKBACK_AGGREGATE | tile_sums[v]);
      }
    }
    open = false;
    bit = 1u;
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP, bit <<= 1) {
      if ((closed & bit) != 0u) continue;
      uint word = status.at[base + v];
      lookback_prefix[v] += word & LOOKBACK_VALUE;
      if ((word & LOOKBACK_INCLUSIVE) != 0u) closed |= bit;
      else open = true;
    }
    open = any_in_workgroup(open);
  }

  if (tile != 0u) {
    [[dont_unroll]] for (uint v = lane; v < LOOKBACK_SUMS; v += LOOKBACK_GROUP) {
      status.at[tile * LOOKBACK_SUMS + v] = LOOKBACK_INCLUSIVE | (lookback_prefix[v] + lookback_own[v]);
    }
  }
  barrier();
  return fallbacks;
}
