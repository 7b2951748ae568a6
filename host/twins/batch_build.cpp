#include <algorithm>
#include <vector>

#include "interface/batch.h"
#include "interface/morton.h"
#include "twins/count_error.h"
#include "twins/scene_box.h"

namespace coppice::twins {

void morton_codes(const MortonCodesArgs& args);
void ploc_leaves(const PlocLeavesArgs& args);
void ploc_finish(const PlocFinishArgs& args);

namespace {

template <class T>
Address<T> address_of(std::vector<T>& values) {
  return {reinterpret_cast<std::uint64_t>(values.data())};
}

template <class T>
Address<T> offset(Address<T> array, std::size_t by) {
  return {array.value + by * sizeof(T)};
}

// As a build of these primitives alone, step by step.
BatchTree build_range(const BatchBuildArgs& args, const BatchRange& range) {
  if (range.count == 0) return {0, 0, 0, 0};
  const Address<const Aabb> boxes = offset(args.boxes, range.first);
  std::vector<BuildState> state(1);
  for (uint i = 0; i < range.count; ++i) {
    if (boxes[i].box_min.x <= boxes[i].box_max.x) add_box(state[0], boxes[i]);
  }
  std::vector<uint> keys(std::size_t{range.count} * args.key_words), values(range.count);
  morton_codes(
      {boxes, address_of(state), address_of(keys), address_of(values), {}, range.count, args.key_words});
  std::ranges::stable_sort(values, {}, [&](uint i) {
    return args.key_words == 1 ? keys[i] : std::uint64_t{keys[2 * i + 1]} << 32 | keys[2 * i];
  });
  std::vector<Node> clusters(range.count);
  std::vector<PlocRound> rounds(BATCH_ROUNDS_BOUND + 1);
  ploc_leaves({boxes, address_of(values), address_of(clusters), address_of(state), address_of(rounds),
               range.count, 0});
  ploc_finish({address_of(clusters),
               {},
               offset(args.nodes, 2 * std::size_t{range.first}),
               address_of(state),
               address_of(rounds),
               args.radius,
               BATCH_ROUNDS_BOUND});
  return {state[0].active_count, state[0].round_count, state[0].error_word, 0};
}

}  // namespace

void batch_build(const BatchBuildArgs& args) {
  note_count(args.state[0], args.count_at, args.range_count);
  const uint count = counted(args.count_at, args.range_count);
  const uint primitive_count = counted(args.primitives_at, args.primitive_count);
  for (uint i = 0; i < count; ++i) {
    const BatchRange range = args.ranges[i];
    const bool sound =
        range.count <= BATCH_MAX_PRIMITIVES && std::uint64_t{range.first} + range.count <= primitive_count;
    args.trees[i] = sound ? build_range(args, range) : BatchTree{0, 0, ERROR_BATCH_RANGE, 0};
    args.state[0].error_word |= args.trees[i].error_word;
  }
}

}  // namespace coppice::twins
