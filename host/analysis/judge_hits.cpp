#include "analysis/judge_hits.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cfloat>
#include <stdexcept>

#include "analysis/hit_room.h"
#include "builders/leaves.h"

namespace coppice {
namespace {

constexpr double NEVER = std::numeric_limits<double>::infinity();

bool has_equal_corners(const Triangle& triangle) {
  return triangle.a == triangle.b || triangle.b == triangle.c || triangle.c == triangle.a;
}

// Of a ray that can hit, on a triangle that is active.
std::string_view why_false_there(const ExactLine& line, const Triangle& triangle, const Hit& hit) {
  if (!std::isfinite(hit.t) || hit.t < line.ray.t_min || hit.t > line.ray.t_max) return "t out of range";
  if (has_equal_corners(triangle)) return "on a triangle of fewer than three corners";
  const HitRoom room(line, triangle);
  if (room.is_segment() || is_exactly_degenerate(triangle)) {
    return room.admits_on_segment(hit) ? "" : "off the segment that the triangle is";
  }
  if (room.gap > room.delta) return "the line passes beside the triangle";
  if (!room.admits_distance(hit.t)) return "t is wrong";
  if (!room.admits_coordinates(hit.u, hit.v)) return "u or v is wrong";
  return {};
}

// Whether all t that may be reported can be, wherever rounding leads.
bool is_within_range(const HitRoom& room, const Ray& ray) {
  const Interval t = room.distances();
  return t.low >= ray.t_min && t.high <= std::min(ray.t_max, FLT_MAX);
}

// What the ray meets in truth, as far as it matters for what was reported.
struct Truth {
  std::optional<Candidate> closest;
  double clear = NEVER;    // the least of the greatest t that may be reported for a clear hit
  double at_edge = NEVER;  // likewise, for hits near a border
};

Truth find_truth(std::span<const Node> nodes, std::span<const Triangle> triangles, const ExactLine& line,
                 std::vector<WalkEntry>& stack) {
  Truth truth;
  ClosestCandidate closest(line, triangles);
  const double t_max = line.ray.t_max;
  const auto limit = [&] { return std::min(truth.clear, t_max); };
  const auto exact_limit = [&] {
    return closest.best() ? std::max(closest.best()->t.high, std::min(truth.at_edge, limit())) : limit();
  };
  walk_triangles(nodes, triangles, line, stack, limit, [&](std::uint32_t index) {
    const auto candidate = find_candidate(line, triangles, index, exact_limit());
    if (!candidate || !candidate->in_range || candidate->t.low > limit()) return;
    closest.offer(*candidate);
    const HitRoom room(line, triangles[index]);
    if (!is_within_range(room, line.ray)) return;
    double& least = room.border > room.delta ? truth.clear : truth.at_edge;
    least = std::min(least, room.distances().high);
  });
  truth.closest = closest.best();
  return truth;
}

double last_place_of(double t) {
  const int power = t == 0 ? FLT_MIN_EXP - 1 : std::clamp(std::ilogb(t), FLT_MIN_EXP - 1, FLT_MAX_EXP - 1);
  return std::ldexp(1.0, power - 23);
}

void keep_first(std::uint64_t& example, std::uint64_t ray) { example = std::min(example, ray); }

void keep_worst(double& worst, std::uint64_t& example, double error, std::uint64_t ray) {
  if (error > worst || (error == worst && error > 0 && ray < example)) {
    worst = error;
    example = ray;
  }
}

// Judges ray after ray and sums up.
class Judge {
 public:
  Judge(std::span<const Node> nodes, std::span<const Triangle> triangles, std::span<const Ray> rays,
        std::span<const Hit> hits)
      : nodes_(nodes), triangles_(triangles), rays_(rays), hits_(hits) {}
  Judge(Judge& other, tbb::split) : Judge(other.nodes_, other.triangles_, other.rays_, other.hits_) {}

  void operator()(const tbb::blocked_range<std::uint64_t>& range) {
    for (std::uint64_t i = range.begin(); i < range.end(); ++i) judge(i);
  }

  void join(const Judge& other) { verdicts += other.verdicts; }

  HitVerdicts verdicts;

 private:
  void judge(std::uint64_t i) {
    const Ray& ray = rays_[i];
    const Hit& hit = hits_[i];
    const bool is_reported = hit.triangle != NO_TRIANGLE;
    ++verdicts.rays;
    verdicts.hits += is_reported;
    const std::string_view reason = is_reported ? why_false(triangles_, ray, hit) : std::string_view();
    if (!reason.empty()) {
      ++verdicts.false_hits;
      verdicts.false_on_degenerate +=
          hit.triangle < triangles_.size() && is_exactly_degenerate(triangles_[hit.triangle]);
      keep_first(verdicts.example_false, i);
    }
    if (!can_hit(ray)) return;
    const ExactLine line(ray);
    const Truth truth = find_truth(nodes_, triangles_, line, stack_);
    verdicts.exact_hits += truth.closest.has_value();
    const bool is_right = is_reported && reason.empty();
    const double t = is_right ? double{hit.t} : NEVER;
    if (truth.clear < t) {
      ++verdicts.missed;
      keep_first(verdicts.example_missed, i);
      return;
    }
    if (truth.at_edge < t && is_right) ++verdicts.behind_edges;
    if (truth.at_edge < t && !is_right) {
      ++verdicts.missed_at_edges;
      keep_first(verdicts.example_missed_at_edges, i);
    }
    if (!is_right) return;
    verdicts.other_triangle += !truth.closest || truth.closest->triangle != hit.triangle;
    measure(i, line);
  }

  void measure(std::uint64_t i, const ExactLine& line) {
    const Hit& hit = hits_[i];
    const Triangle& triangle = triangles_[hit.triangle];
    const ExactMeeting exact = exact_meeting(triangle, rays_[i]);
    const HitRoom room(line, triangle);
    if (!exact.meets || room.border <= room.delta || !is_within_range(room, line.ray)) return;
    const double t_error = std::abs(hit.t - exact.t);
    keep_worst(verdicts.worst_t_ulps, verdicts.example_t, t_error / last_place_of(exact.t), i);
    const double uv_error = std::max(std::abs(hit.u - exact.u), std::abs(hit.v - exact.v));
    keep_worst(verdicts.worst_uv_ulps, verdicts.example_uv, uv_error * 0x1p24, i);
    verdicts.worst_t_scaled = std::max(verdicts.worst_t_scaled, t_error * room.length / room.reach * 0x1p24);
  }

  std::span<const Node> nodes_;
  std::span<const Triangle> triangles_;
  std::span<const Ray> rays_;
  std::span<const Hit> hits_;
  std::vector<WalkEntry> stack_;
};

}  // namespace

std::string_view why_false(std::span<const Triangle> triangles, const Ray& ray, const Hit& hit) {
  if (hit.triangle == NO_TRIANGLE) return {};
  if (hit.triangle >= triangles.size()) return "no such triangle";
  if (!can_hit(ray)) return "the ray hits nothing";
  const Triangle& triangle = triangles[hit.triangle];
  if (!is_active(triangle)) return "on an inactive triangle";
  return why_false_there(ExactLine(ray), triangle, hit);
}

HitVerdicts& HitVerdicts::operator+=(const HitVerdicts& other) {
  rays += other.rays;
  hits += other.hits;
  exact_hits += other.exact_hits;
  missed += other.missed;
  missed_at_edges += other.missed_at_edges;
  behind_edges += other.behind_edges;
  false_hits += other.false_hits;
  false_on_degenerate += other.false_on_degenerate;
  other_triangle += other.other_triangle;
  keep_first(example_missed, other.example_missed);
  keep_first(example_missed_at_edges, other.example_missed_at_edges);
  keep_first(example_false, other.example_false);
  keep_worst(worst_t_ulps, example_t, other.worst_t_ulps, other.example_t);
  keep_worst(worst_uv_ulps, example_uv, other.worst_uv_ulps, other.example_uv);
  worst_t_scaled = std::max(worst_t_scaled, other.worst_t_scaled);
  return *this;
}

HitVerdicts judge_hits(std::span<const Node> nodes, std::span<const Triangle> triangles,
                       std::span<const Ray> rays, std::span<const Hit> hits) {
  if (rays.size() != hits.size()) throw std::invalid_argument("judge_hits: as many hits as rays are needed");
  Judge judge(nodes, triangles, rays, hits);
  tbb::parallel_reduce(tbb::blocked_range<std::uint64_t>(0, rays.size()), judge);
  return judge.verdicts;
}

}  // namespace coppice
