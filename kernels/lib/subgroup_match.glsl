// Which invocations of the subgroup hold the same digit. All invocations call these; those without a key give a digit
// of their own kind, 1 << bits.

#include "lib/subgroup.glsl"

struct Match {
  uint before;   // earlier invocations with the same digit
  bool is_last;  // no later invocation has it
};

// Adinets and Merrill 2022, section 4.4: one ballot a bit.
Match match_by_ballot(uint digit, uint bits) {
  uvec4 equal = subgroupBallot(true);
  [[dont_unroll]] for (uint bit = 0u; bit <= bits; ++bit) {
    bool set = bitfieldExtract(digit, int(bit), 1) != 0u;
    uvec4 ballot = subgroupBallot(set);
    equal &= set ? ballot : ~ballot;
  }
  return Match(subgroupBallotExclusiveBitCount(equal), subgroupBallotBitCount(equal & gl_SubgroupGtMask) == 0u);
}

// In a narrow subgroup each digit is compared with all: on CPU devices less than half the time of ballots.
Match match_digit(uint digit, uint bits) {
  if (LANES > 16u) return match_by_ballot(digit, bits);
  uint both = 0u;  // four bits count the earlier ones, the next four the later ones
  [[unroll]] for (uint other = 0u; other < 16u; ++other) {
    if (other >= LANES) continue;
    uint unit = other < lane() ? 1u : other > lane() ? 16u : 0u;
    both += subgroupBroadcast(digit, other) == digit ? unit : 0u;
  }
  return Match(both & 15u, both < 16u);
}
