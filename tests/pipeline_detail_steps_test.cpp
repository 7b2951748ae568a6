// What a ray costs in a detail does not grow with the size of what is around it: on every tree, whatever the
// ratio.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "builders/morton_crowding.h"
#include "builders/ploc.h"
#include "measure/traffic.h"
#include "pipeline/trace_plan.h"
#include "scene/hard_cases.h"
#include "support/wide.h"

namespace coppice {
namespace {

// A camera's rays at the pots of radius 6 around (0, 6, 0), 64 after each other within a square.
std::vector<Ray> rays_at_detail() {
  constexpr std::uint32_t squares = 8, side = 8;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < squares * squares * side * side; ++i) {
    const std::uint32_t square = i / (side * side), place = i % (side * side);
    const auto along = [](std::uint32_t pixel) { return static_cast<float>(pixel) / 32 - 0.97f; };
    const float x = along(square % squares * side + place / side),
                y = along(square / squares * side + place % side);
    rays.push_back({vec3(1, 12, 25), 0, vec3(6 * x, 6 * y - 6, -25), infinity});
  }
  return rays;
}

struct Way {
  Walk walk;
  std::uint32_t box_test;
};

constexpr Way FAST = {Walk::binary, BOX_FAST}, BINARY = {Walk::binary, BOX_ROBUST},
              PACKETS = {Walk::wide_packets, BOX_ROBUST}, SINGLE = {Walk::wide_single, BOX_ROBUST};

// By the twins, which count as the kernels do.
class Detail {
 public:
  explicit Detail(std::span<const Triangle> triangles) {
    const Bvh bvh = build_ploc(triangles, {.radius = 8, .morton_bits = choose_morton_bits(triangles)});
    tree_ = plan_uploaded(layout_, bvh.nodes);
    triangles_ = layout_.add<Triangle>("detail", triangles.size());
    rays_ = {layout_.add<Ray>("rays", rays.size()), layout_.add<Hit>("hits", rays.size()),
             layout_.add<TraceCounters>("counters", 1)};
    executor_.emplace(layout_);
    upload_tree(*executor_, tree_.tree, bvh.nodes);
    tree_.tree.triangles = triangles_;
    executor_->upload(triangles_, triangles);
    executor_->upload(rays_.rays, std::span<const Ray>(rays));
    Chain chain = executor_->chain();
    append_wide(chain, tree_.tree, tree_.wide);
    executor_->run(chain.steps());
  }

  double steps_per_ray(const Way& way) {
    std::vector<Hit> misses(rays.size(), {std::numeric_limits<float>::infinity(), NO_TRIANGLE, 0, 0});
    executor_->upload(rays_.hits, std::span<const Hit>(misses));
    TraceOptions options;
    options.walk = way.walk;
    options.box_test = way.box_test;
    Chain chain = executor_->chain();
    chain.clear(rays_.counters);
    append_closest_hits(chain, tree_.tree, rays_, static_cast<std::uint32_t>(rays.size()), options);
    executor_->run(chain.steps());
    const auto counts = counts_of_trace(executor_->read(rays_.counters)[0]);
    EXPECT_GT(counts.hits, rays.size() / 4);
    return static_cast<double>(counts.steps) / static_cast<double>(rays.size());
  }

 private:
  const std::vector<Ray> rays = rays_at_detail();
  Layout layout_;
  UploadedTree tree_;
  Slot<Triangle> triangles_;
  RaySlots rays_;
  std::optional<CpuExecutor> executor_;
};

TEST(RaysAtADetail, TakeStepsAsIfThereWereNothingElse) {
  std::vector<Triangle> pot;
  const Scene scene = find_hard_case("detail-on-ground")->make(5000, 1);
  for (const glm::uvec3 t : scene.indices)
    pot.push_back({scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]});
  const std::size_t ground = pot.size() - 2;

  double fast_at_1 = 0, packets_at_1 = 0, single_at_1 = 0;
  for (const float ratio : {1.0f, 10.0f, 30.0f, 100.0f, 300.0f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f}) {
    std::vector<Triangle> triangles = pot;
    for (std::size_t k = ground; k < pot.size(); ++k)
      triangles[k] = {pot[k].a * 1e-6f * ratio, pot[k].b * 1e-6f * ratio, pot[k].c * 1e-6f * ratio};
    Detail detail(triangles);
    const double fast = detail.steps_per_ray(FAST), binary = detail.steps_per_ray(BINARY),
                 packets = detail.steps_per_ray(PACKETS), single = detail.steps_per_ray(SINGLE);
    if (ratio == 1) {
      fast_at_1 = fast;
      packets_at_1 = packets;
      single_at_1 = single;
    }
    // The wide walks have no fast test to compare with; what the binary tree of that ratio costs counts as
    // it.
    const double tree = fast / fast_at_1;
    EXPECT_LE(binary, 1.2 * fast) << ratio;
    EXPECT_LE(packets, 1.2 * tree * packets_at_1) << ratio << ", tree " << tree;
    EXPECT_LE(single, 1.2 * tree * single_at_1) << ratio << ", tree " << tree;
  }
}

}  // namespace
}  // namespace coppice
