// Every struct that kernels and host share has the same layout on both sides.
#include <gtest/gtest.h>

#include <set>

#include "stages/stages.h"
#include "support/fields.h"
#include "support/spirv_layout.h"

namespace coppice {

// Arrays hide from field_offsets how many members there are.
template <>
std::vector<std::uint32_t> field_offsets<WideNode>() {
  return {offsetof(WideNode, origin), offsetof(WideNode, exponents), offsetof(WideNode, planes),
          offsetof(WideNode, child)};
}

template <>
std::vector<std::uint32_t> field_offsets<Joint>() {
  return {offsetof(Joint, rows)};
}

namespace {

template <class T>
void expect_same_layout(const char* name, std::set<std::string>& seen) {
  for (const StageDeclaration* stage : all_stages()) {
    const auto layouts = struct_layouts(stage->kernel);
    const auto found = layouts.find(name);
    if (found == layouts.end() || found->second.offsets.empty()) continue;
    seen.insert(name);
    EXPECT_EQ(found->second.offsets, field_offsets<T>()) << name << " in " << stage->name;
    if (found->second.array_stride) {
      EXPECT_EQ(found->second.array_stride, sizeof(T)) << name << " in " << stage->name;
    }
  }
}

#define EXPECT_SAME_LAYOUT(T) expect_same_layout<T>(#T, seen)

TEST(SharedLayout, ArgsOfEveryStage) {
  std::set<std::string> seen;
  std::size_t structs = 0;
#define COPPICE_CHECK_ARGS(stem, Args, Constants, nearly) EXPECT_SAME_LAYOUT(Args);
  COPPICE_STAGES(COPPICE_CHECK_ARGS)
#undef COPPICE_CHECK_ARGS
  std::set<std::string> expected;
#define COPPICE_NAME_ARGS(stem, Args, Constants, nearly) expected.insert(#Args);
  COPPICE_STAGES(COPPICE_NAME_ARGS)
#undef COPPICE_NAME_ARGS
  structs = expected.size();
  EXPECT_EQ(seen.size(), structs) << "an Args struct was found in no kernel";
}

TEST(SharedLayout, ElementsOfEverySlot) {
  std::set<std::string> seen;
  EXPECT_SAME_LAYOUT(Triangle);
  EXPECT_SAME_LAYOUT(Aabb);
  EXPECT_SAME_LAYOUT(Node);
  EXPECT_SAME_LAYOUT(BuildState);
  EXPECT_SAME_LAYOUT(PlocRound);
  EXPECT_SAME_LAYOUT(BatchRange);
  EXPECT_SAME_LAYOUT(BatchTree);
  EXPECT_SAME_LAYOUT(Ray);
  EXPECT_SAME_LAYOUT(Hit);
  EXPECT_SAME_LAYOUT(BoxCandidate);
  EXPECT_SAME_LAYOUT(Film);
  EXPECT_SAME_LAYOUT(SurfaceMaterial);
  EXPECT_SAME_LAYOUT(Lighting);
  EXPECT_SAME_LAYOUT(LightSource);
  EXPECT_SAME_LAYOUT(TraceCounters);
  EXPECT_SAME_LAYOUT(ShowScale);
  EXPECT_SAME_LAYOUT(ShowRange);
  EXPECT_SAME_LAYOUT(WideNode);
  EXPECT_SAME_LAYOUT(WideEntry);
  EXPECT_SAME_LAYOUT(WideLevel);
  EXPECT_SAME_LAYOUT(WideCounts);
  EXPECT_SAME_LAYOUT(SequenceStep);
  EXPECT_SAME_LAYOUT(DeformStep);
  EXPECT_SAME_LAYOUT(Joint);
  EXPECT_SAME_LAYOUT(VertexJoints);
  EXPECT_SAME_LAYOUT(RefitLevel);
  EXPECT_SAME_LAYOUT(RefitState);
  EXPECT_SAME_LAYOUT(InstanceTransform);
  EXPECT_SAME_LAYOUT(MeshRange);
  EXPECT_SAME_LAYOUT(PlacedInstance);
  EXPECT_SAME_LAYOUT(LuminanceSums);
  EXPECT_SAME_LAYOUT(AlphaMap);
  EXPECT_SAME_LAYOUT(AlphaTriangle);
  EXPECT_EQ(seen.size(), 33u);
}

}  // namespace
}  // namespace coppice
