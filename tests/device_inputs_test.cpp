// Triangles as others keep them: gathered in lockstep with the twins, and the tree
// over them is that of the same triangles as the command line has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "analysis/tree_hash.h"
#include "builders/ploc.h"
#include "interface/gather.h"
#include "render/scene_arrays.h"
#include "scene/hard_cases.h"
#include "scene/random.h"
#include "support/counted_run.h"
#include "support/lockstep.h"

namespace coppice {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

// How a test lays out its arrays.
struct Arrangement {
  std::uint32_t stride = 12, index_bytes = 0;         // 0: no indices
  std::uint32_t vertex_offset = 0, index_offset = 0;  // bytes before the first
  std::uint32_t first_vertex = 0;
  bool transform = false;
};

struct Mesh {
  std::vector<vec3> positions;
  std::vector<uint> indices;
};

vec3 flushed(vec3 v) {
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = std::fpclassify(v[axis]) == FP_SUBNORMAL ? 0.0f : v[axis] + 0.0f;
  return v;
}

constexpr float transform_rows[12] = {0.75f,     -0.5f, 0.125f, 10,   0,  2.5f,
                                      -1.0f / 3, -7,    1e-39f, 0.1f, -3, -0.0f};

vec3 transformed(vec3 v) {
  const auto row = [&](int first) {
    return transform_rows[first] * v.x + transform_rows[first + 1] * v.y + transform_rows[first + 2] * v.z +
           transform_rows[first + 3];
  };
  return {row(0), row(4), 0.0f * v.x + transform_rows[9] * v.y + transform_rows[10] * v.z};
}

bool same_words(std::span<const Triangle> a, std::span<const Triangle> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

class DeviceInputs : public DeviceTest {
 protected:
  struct Gathered {
    std::vector<Triangle> triangles;
    std::vector<Node> nodes;
    BuildState state;
  };

  // Gathers and builds in lockstep.
  static Gathered gather(const Mesh& mesh, const Arrangement& how, std::optional<uint> asked = {}) {
    const std::size_t corners =
        how.index_bytes ? mesh.indices.size() : mesh.positions.size() - how.first_vertex;
    const auto count = static_cast<std::uint32_t>(corners / 3);
    CountedRun run;
    const auto vertices =
        run.layout.add<std::byte>("vertices", how.vertex_offset + mesh.positions.size() * how.stride);
    const auto indices =
        run.layout.add<std::byte>("indices", how.index_offset + mesh.indices.size() * how.index_bytes);
    const auto transform = run.layout.add<float>("transform", 12);
    const BuildPlan plan = plan_build(run.layout, count, {});
    run.start(asked.value_or(0));
    std::vector<std::byte> bytes(vertices.count, std::byte{0xff});
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      std::memcpy(&bytes[how.vertex_offset + i * how.stride], &mesh.positions[i], sizeof(vec3));
    run.upload(vertices, bytes);
    bytes.assign(indices.count, std::byte{0xff});
    for (std::size_t i = 0; how.index_bytes && i < mesh.indices.size(); ++i)  // little-endian
      std::memcpy(&bytes[how.index_offset + i * how.index_bytes], &mesh.indices[i], how.index_bytes);
    run.upload(indices, bytes);
    run.upload(transform, std::vector<float>(std::begin(transform_rows), std::end(transform_rows)));
    run.fill(plan.triangles);
    run.expect_same_bits([&](Chain& chain) {
      VertexTriangles input;
      input.vertices.value = chain.at(vertices, how.vertex_offset).value;
      if (how.index_bytes) input.indices.value = chain.at(indices, how.index_offset).value;
      if (how.transform) input.transform.value = chain.at(transform).value;
      input.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
      input.vertex_stride = how.stride;
      input.first_vertex = how.first_vertex;
      if (how.index_bytes) input.index_bytes = how.index_bytes;
      append_build(chain, plan, {input, asked ? chain.at(run.count) : UintBuffer{}});
    });
    Gathered gathered{run.read(plan.triangles), run.read(plan.nodes), run.read(plan.state)[0]};
    if (const std::uint64_t active = gathered.state.active_count)
      gathered.nodes.resize(2 * active - 1);
    else
      gathered.nodes.clear();
    return gathered;
  }

  // What gather is to find, all finite.
  static std::vector<Triangle> expected(const Mesh& mesh, const Arrangement& how) {
    std::vector<vec3> corners;
    if (how.index_bytes) {
      for (const uint index : mesh.indices) corners.push_back(mesh.positions[index + how.first_vertex]);
    } else {
      corners.assign(mesh.positions.begin() + how.first_vertex, mesh.positions.end());
    }
    for (vec3& corner : corners) corner = how.transform ? transformed(flushed(corner)) : flushed(corner);
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 3 <= corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return triangles;
  }

  static void expect_gathered(const Mesh& mesh, const Arrangement& how) {
    const Gathered gathered = gather(mesh, how);
    if (HasFatalFailure()) return;
    const std::vector<Triangle> triangles = expected(mesh, how);
    EXPECT_TRUE(same_words(gathered.triangles, triangles));
    EXPECT_EQ(tree_hash(gathered.nodes), tree_hash(build_ploc(triangles, {16, 30}).nodes));
  }

  static Mesh random_mesh(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t first_vertex) {
    Random random(vertices * 31 + triangles);
    Mesh mesh;
    for (std::uint32_t i = 0; i < vertices; ++i) mesh.positions.push_back(random.in_cube());
    mesh.positions[5] = {-0.0f, 1e-40f, -1e-40f};
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
      mesh.indices.push_back(random.below(vertices - first_vertex));
    return mesh;
  }
};

TEST_F(DeviceInputs, EveryStrideIndexAndOffset) {
  for (const std::uint32_t index_bytes : {0u, 2u, 4u}) {
    for (const std::uint32_t stride : {12u, 16u, 20u, 32u, 100u}) {
      for (const bool transform : {false, true}) {
        Arrangement how{stride, index_bytes, 4 * (stride % 3), index_bytes * (stride / 4 % 2), 0, transform};
        how.first_vertex = stride % 5;
        SCOPED_TRACE("indices of " + std::to_string(index_bytes) + " bytes, stride " +
                     std::to_string(stride) + (transform ? ", transformed" : ""));
        expect_gathered(random_mesh(2000, 1500, how.first_vertex), how);
      }
    }
  }
}

TEST_F(DeviceInputs, NoneToAFewTriangles) {
  for (const std::uint32_t count : {0u, 1u, 2u, 3u, 1023u, 1024u, 1025u}) {
    for (const std::uint32_t index_bytes : {2u, 4u})
      expect_gathered(random_mesh(100, count, 0), {.index_bytes = index_bytes, .index_offset = index_bytes});
  }
}

// Each makes its triangle inactive, and reads nothing.
TEST_F(DeviceInputs, IndicesOutOfRangeAndCornersThatAreNotFinite) {
  for (const std::uint32_t index_bytes : {2u, 4u}) {
    Mesh mesh = random_mesh(300, 200, 7);
    const uint largest = index_bytes == 2 ? 0xffffu : 0xffffffffu;
    mesh.indices[3 * 10] = 293;              // the first behind the last
    mesh.indices[3 * 20 + 1] = largest;      // and 6 more are small numbers again
    mesh.indices[3 * 30 + 2] = largest - 7;  // the largest sum
    mesh.indices[3 * 199 + 2] = 300;
    mesh.positions[50] = {0, nan_value, 0};
    mesh.positions[51] = {0, 0, -infinite};
    for (uint& index : mesh.indices) index = index + 7 == 50 || index + 7 == 51 ? 0 : index;
    mesh.indices[3 * 40] = 43;
    mesh.indices[3 * 41 + 2] = 44;
    const Gathered gathered = gather(mesh, {.index_bytes = index_bytes, .first_vertex = 7});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(gathered.state.active_count, 194u);
    for (const std::size_t i : {10u, 20u, 30u, 40u, 41u, 199u}) {
      for (const vec3& corner : {gathered.triangles[i].a, gathered.triangles[i].b, gathered.triangles[i].c})
        EXPECT_EQ(std::bit_cast<uint>(corner.y), GATHERED_INACTIVE) << i;
    }
  }
}

TEST_F(DeviceInputs, ATransformThatLeavesTheRangeOfFloatMakesInactive) {
  Mesh mesh = random_mesh(30, 10, 0);
  mesh.positions[3] = vec3(3e38f, 3e38f, 3e38f);
  mesh.indices.clear();
  const Gathered gathered = gather(mesh, {.transform = true});
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(gathered.state.active_count, 9u);
}

TEST_F(DeviceInputs, CountsOnTheDevice) {
  const Mesh mesh = random_mesh(2000, 3000, 0);
  const std::vector<Triangle> triangles = expected(mesh, {.index_bytes = 4});
  for (const uint asked : {0u, 1u, 1000u, 1024u, 1025u, 3000u, 3001u}) {
    const Gathered gathered = gather(mesh, {.index_bytes = 4}, asked);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_EQ(gathered.state.primitive_count, asked);
    EXPECT_EQ(gathered.state.error_word, asked > 3000 ? ERROR_COUNT : 0u);
    const std::size_t count = std::min(asked, 3000u);
    EXPECT_TRUE(same_words(std::span(gathered.triangles).first(count), std::span(triangles).first(count)));
    for (std::size_t i = count; i < 3000; ++i)
      ASSERT_EQ(std::bit_cast<uint>(gathered.triangles[i].a.x), SENTINEL) << "behind the count";
    if (asked > 3000) continue;
    EXPECT_EQ(tree_hash(gathered.nodes),
              tree_hash(build_ploc(std::span(triangles).first(count), {16, 30}).nodes));
  }
}

// Raw vertices and indices give the tree that the command line gives for the scene, denormals, -0 and all.
class DeviceInputsHardCases : public DeviceInputs, public testing::WithParamInterface<std::string_view> {};

TEST_P(DeviceInputsHardCases, TheTreeOfTheCommandLine) {
  const HardCase* const hard_case = find_hard_case(GetParam());
  const Scene scene = hard_case->make(std::min(hard_case->default_triangle_count, 3000u), 1);
  Mesh mesh{scene.positions, {}};
  for (const uvec3& corners : scene.indices)
    mesh.indices.insert(mesh.indices.end(), {corners.x, corners.y, corners.z});
  const Gathered gathered = gather(mesh, {.index_bytes = 4});
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(tree_hash(gathered.nodes), tree_hash(build_ploc(scene_arrays(scene).triangles, {16, 30}).nodes));
}

INSTANTIATE_TEST_SUITE_P(Cases, DeviceInputsHardCases, testing::ValuesIn(hard_case_names()),
                         [](const auto& info) {
                           std::string name(info.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(BuildInputs, RefusesWhatNoKernelReads) {
  Layout layout;
  const BuildPlan triangles = plan_build(layout, 10, {}),
                  boxes = plan_build(layout, 10, {}, PrimitiveKind::boxes);
  const std::vector<std::uint64_t> addresses(layout.block_bytes().size(), 1 << 20);
  Chain chain(addresses);
  const auto refused = [&](const BuildPlan& plan, const BuildInput& input) {
    EXPECT_THROW(append_build(chain, plan, input), std::invalid_argument);
  };
  const VertexTriangles sound{{4096}, {8192}, {}, 100};
  EXPECT_NO_THROW(append_build(chain, triangles, {sound, {}}));
  EXPECT_NO_THROW(append_build(chain, boxes, {GivenBoxes{{4096}}, {}}));
  VertexTriangles input = sound;
  input.vertices.value += 2, refused(triangles, {input, {}}), input = sound;
  input.indices.value += 2, refused(triangles, {input, {}}), input = sound;
  input.index_bytes = 1, refused(triangles, {input, {}}), input = sound;
  input.vertex_stride = 8, refused(triangles, {input, {}}), input = sound;
  input.vertex_stride = 14, refused(triangles, {input, {}}), input = sound;
  input.transform.value = 4097, refused(triangles, {input, {}}), input = sound;
  refused(triangles, {sound, {4098}});
  refused(triangles, {GivenBoxes{{4096}}, {}});
  refused(boxes, {sound, {}});
  refused(boxes, {GivenBoxes{{4096}, 20}, {}});
  refused(boxes, {GivenBoxes{{4097}}, {}});
  input.index_bytes = 2, input.indices.value += 2;
  EXPECT_NO_THROW(append_build(chain, triangles, {input, {}}));
}

}  // namespace
}  // namespace coppice
