// The level of a split: where in the radix tree over the sorted codes it lies.
// Of two splits at the ends of a range the one with the lower level is its parent's. They are never equal there: of the
// codes (and places) of one prefix, in ascending order, a bit changes from 0 to 1 only once.

// Of the split between place and place + 1.
uint split_level(uint place) {
  uint first = place * args.key_words;
  if (args.key_words == 2u) {
    uint high = args.keys.at[first + 1u] ^ args.keys.at[first + 3u];
    if (high != 0u) return 2u * HPLOC_CODE_LEVEL + uint(findMSB(high));
  }
  uint low = args.keys.at[first] ^ args.keys.at[first + args.key_words];
  if (low != 0u) return HPLOC_CODE_LEVEL + uint(findMSB(low));
  return uint(findMSB(place ^ (place + 1u)));
}

// Of the split before a place of 0 to place_count.
uint level_before(uint place, uint place_count) {
  return place == 0u || place == place_count ? HPLOC_END_LEVEL : split_level(place - 1u);
}
