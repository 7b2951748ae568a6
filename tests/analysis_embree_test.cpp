// Embree, a tracer that shares nothing with ours, finds the same closest hits in the same triangles.
#include <embree3/rtcore.h>
#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <memory>
#include <string>

#include "analysis/compare.h"
#include "analysis/cpu_tracer.h"
#include "builders/registry.h"
#include "scene/generators.h"
#include "support/hit_referee.h"
#include "support/rays.h"
#include "support/split_trees.h"
#include "support/triangles.h"

namespace coppice {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr std::uint32_t RAY_COUNT = 50'000;
#else
constexpr std::uint32_t RAY_COUNT = 1'000'000;
#endif

template <auto release>
struct Release {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};

// A scene of unconnected triangles in Embree.
class EmbreeScene {
 public:
  explicit EmbreeScene(std::span<const Triangle> triangles)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(vec3), 3 * triangles.size());
    std::memcpy(corners, triangles.data(), triangles.size_bytes());
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), triangles.size()));
    for (unsigned i = 0; i < 3 * triangles.size(); ++i) indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
    EXPECT_EQ(rtcGetDeviceError(device_.get()), RTC_ERROR_NONE);
  }

  std::vector<Hit> trace(std::span<const Ray> rays) const {
    std::vector<Hit> hits(rays.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) hits[i] = closest_hit(rays[i]);
    });
    return hits;
  }

 private:
  Hit closest_hit(const Ray& ray) const {
    RTCRayHit query{};
    query.ray.org_x = ray.origin.x;
    query.ray.org_y = ray.origin.y;
    query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.direction.x;
    query.ray.dir_y = ray.direction.y;
    query.ray.dir_z = ray.direction.z;
    query.ray.tnear = ray.t_min;
    query.ray.tfar = ray.t_max;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {ray.t_max, NO_TRIANGLE, 0, 0};
    return {query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v};
  }

  std::unique_ptr<RTCDeviceTy, Release<rtcReleaseDevice>> device_;
  std::unique_ptr<RTCSceneTy, Release<rtcReleaseScene>> scene_;
};

struct Subject {
  const char* scene;
  std::vector<Triangle> (*make)();
  std::vector<const char*> builders;
};

void PrintTo(const Subject& subject, std::ostream* out) { *out << subject.scene; }

class Embree : public testing::TestWithParam<Subject> {
 protected:
  // Judges the hits of the first builder's tree by Embree's. The other builders' trees must give the first
  // one's, bit for bit.
  Verdicts judge(std::span<const Triangle> triangles, std::span<const Ray> rays) const {
    std::vector<Hit> hits(rays.size()), first;
    for (const char* builder : GetParam().builders) {
      trace_all(find_cpu_builder(builder).build(triangles, {}).nodes, triangles, rays, hits);
      if (first.empty()) first = hits;
      EXPECT_EQ(compare_hits(hits, first).count, 0u) << builder;
    }
    const std::vector<Hit> expected = EmbreeScene(triangles).trace(rays);
    const Verdicts verdicts = judge_all(triangles, rays, first, expected);
    RecordProperty("hits", std::to_string(verdicts.hits));
    RecordProperty("ties", std::to_string(verdicts.ties));
    RecordProperty("borderline", std::to_string(verdicts.borderline));
    const std::size_t i = verdicts.first_wrong;
    EXPECT_EQ(verdicts.wrong, 0u) << "ray " << i << ": triangle " << first[i].triangle << " at " << first[i].t
                                  << ", Embree: " << expected[i].triangle << " at " << expected[i].t;
    return verdicts;
  }
};

TEST_P(Embree, FindsTheSameHits) {
  const std::vector<Triangle> triangles = GetParam().make();
  const std::vector<Ray> rays = rays_around(triangles, RAY_COUNT, 1);
  const Verdicts verdicts = judge(triangles, rays);
  EXPECT_GT(verdicts.hits, rays.size() / 20);
  EXPECT_LE(verdicts.disputed(), rays.size() / 10'000);
}

// Here many rays meet two triangles at once, and float decides whether others meet one at all.
TEST_P(Embree, FindsTheSameHitsAtEdgesButForRounding) {
  const std::vector<Triangle> triangles = GetParam().make();
  const std::vector<Ray> rays = rays_at_edges(triangles, RAY_COUNT / 20, 2);
  const Verdicts verdicts = judge(triangles, rays);
  EXPECT_GT(verdicts.hits, rays.size() / 4);
  EXPECT_GT(verdicts.disputed(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Embree,
    testing::Values(
        Subject{"scatter", [] { return triangles_of(make_scatter(20'000)); }, {"sah", "sah-sweep", "ploc"}},
        Subject{"terrain",
                [] { return triangles_of(make_terrain(20'000)); },
                {"lbvh", "bottom-up", "gd16-early"}},
        Subject{"grove", [] { return triangles_of(make_grove()); }, {"ploc-parallel", "top-down"}},
        Subject{"needles", [] { return needles(2'000, 9); }, {"sbvh", "gd16"}}),
    [](const auto& test) { return std::string(test.param.scene); });

}  // namespace
}  // namespace coppice
