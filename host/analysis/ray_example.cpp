#include "analysis/ray_example.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace coppice {
namespace {

std::string number(double x, int digits = 9) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

std::string numbers(const vec3& v) { return number(v.x) + " " + number(v.y) + " " + number(v.z); }

std::string hit_at(std::uint32_t triangle, double t, int digits) {
  if (triangle == NO_TRIANGLE) return "nothing";
  return "triangle " + std::to_string(triangle) + " at t " + number(t, digits);
}

std::string hit_at(const Hit& hit) { return hit_at(hit.triangle, hit.t, 9); }

std::uint64_t first_leak(std::span<const Hit> hits) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].triangle == NO_TRIANGLE) return i;
  }
  return HitVerdicts::NO_RAY;
}

std::uint64_t first_difference(std::span<const Hit> hits, std::span<const Hit> twins) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (std::memcmp(&hits[i], &twins[i], sizeof(Hit)) != 0) return i;
  }
  return HitVerdicts::NO_RAY;
}

// What is wrong with the hit, and where the ray's line meets the triangle in truth.
std::string reason_of_false(const TracedBatch& batch, std::uint64_t index) {
  const Ray& ray = batch.rays[index];
  const Hit& hit = batch.hits[index];
  std::string reason(why_false(batch.triangles, ray, hit));
  if (hit.triangle >= batch.triangles.size()) return reason;
  const ExactMeeting meeting = exact_meeting(batch.triangles[hit.triangle], ray);
  return reason + (meeting.meets ? "; the line meets it at t " + number(meeting.t, 17)
                                 : "; the line does not meet it");
}

RayExample example_at(const TracedBatch& batch, std::uint64_t index, std::string_view failure,
                      std::string_view kind) {
  const Ray& ray = batch.rays[index];
  return {failure, kind, index, ray, batch.hits[index], closest_exact(batch.nodes, batch.triangles, ray), {}};
}

}  // namespace

std::vector<RayExample> examples_of(const TracedBatch& batch, const HitVerdicts& verdicts,
                                    std::span<const Hit> twins, std::string_view kind, bool is_closed) {
  std::vector<RayExample> examples;
  const auto add = [&](std::uint64_t index, std::string_view failure) {
    if (index == HitVerdicts::NO_RAY) return;
    examples.push_back(example_at(batch, index, failure, kind));
    if (failure == FALSE_HIT) examples.back().reason = reason_of_false(batch, index);
    if (failure == OTHER_BITS) examples.back().reason = "the twin has " + hit_at(twins[index]);
  };
  add(verdicts.example_false, FALSE_HIT);
  add(verdicts.example_missed, MISSED);
  if (is_closed) add(first_leak(batch.hits), LEAK);
  add(first_difference(batch.hits, twins), OTHER_BITS);
  add(verdicts.example_missed_at_edges, MISSED_AT_EDGE);
  return examples;
}

RayExample example_of_leak(const TracedBatch& batch, std::string_view kind) {
  return example_at(batch, first_leak(batch.hits), LEAK, kind);
}

std::string described(const RayExample& example) {
  const Ray& ray = example.ray;
  return std::string(example.failure) + ": ray " + std::to_string(example.index) + " of " +
         std::string(example.kind) + ", origin " + numbers(ray.origin) + ", direction " +
         numbers(ray.direction) + ", t " + number(ray.t_min) + " to " + number(ray.t_max) + ": " +
         hit_at(example.hit) + ", expected " +
         hit_at(example.expected.triangle, example.expected.meeting.t, 17) +
         (example.reason.empty() ? "" : ": " + example.reason);
}

}  // namespace coppice
