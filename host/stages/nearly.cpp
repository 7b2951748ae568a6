#include "stages/nearly.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "interface/paths.h"

namespace coppice {

namespace {

constexpr float vector_tolerance = 0x1p-18f, t_tolerance = 0x1p-16f, colour_tolerance = 0x1p-16f;
constexpr float noise_tolerance = 0x1p-12f;
constexpr float barycentric_tolerance = 0.0625f;

std::uint64_t thousandth(std::uint64_t count) { return (count + 900) / 1000; }
std::uint64_t hundredth(std::uint64_t count) { return (count + 90) / 100; }

enum class Verdict { within, tied, beyond };

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

// Not for a NaN, nor for infinities that are not the same.
bool within(float a, float b, float limit) { return same_bits(a, b) || std::abs(a - b) <= limit; }

float largest(vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

bool within(vec3 a, vec3 b, float limit) {
  return std::isfinite(limit) ? within(a.x, b.x, limit) && within(a.y, b.y, limit) && within(a.z, b.z, limit)
                              : same_bits(a, b);
}

Verdict judge(const Ray& cpu, const Ray& gpu, NearlyEqual&) {
  const bool alike = same_bits(cpu.t_min, gpu.t_min) && same_bits(cpu.t_max, gpu.t_max) &&
                     within(cpu.origin, gpu.origin, vector_tolerance * largest(cpu.origin)) &&
                     within(cpu.direction, gpu.direction, vector_tolerance * largest(cpu.direction));
  return alike ? Verdict::within : Verdict::beyond;
}

Verdict judge(const Hit& cpu, const Hit& gpu, NearlyEqual& result) {
  if (cpu.triangle == NO_TRIANGLE || gpu.triangle == NO_TRIANGLE) return Verdict::beyond;
  const float scale = std::max(std::abs(cpu.t), std::abs(gpu.t));
  if (!within(cpu.t, gpu.t, t_tolerance * scale)) return Verdict::beyond;
  if (cpu.t != gpu.t)
    result.largest_relative_t = std::max(result.largest_relative_t, std::abs(double{cpu.t} - gpu.t) / scale);
  if (cpu.triangle != gpu.triangle) return Verdict::tied;
  return within(cpu.u, gpu.u, barycentric_tolerance) && within(cpu.v, gpu.v, barycentric_tolerance)
             ? Verdict::within
             : Verdict::beyond;
}

struct AnyHit {
  uint word;
};

Verdict judge(const AnyHit& cpu, const AnyHit& gpu, NearlyEqual& result) {
  if (cpu.word > 1 || gpu.word > 1) result.beyond_allowed = 0;
  return Verdict::beyond;
}

struct HitInstance {
  uint word;
};

Verdict judge(const HitInstance&, const HitInstance&, NearlyEqual&) { return Verdict::beyond; }

Verdict judge(const BoxCandidate& cpu, const BoxCandidate& gpu, NearlyEqual&) {
  const float scale = std::max(std::abs(cpu.t_enter), std::abs(gpu.t_enter));
  return cpu.primitive == gpu.primitive && within(cpu.t_enter, gpu.t_enter, t_tolerance * scale)
             ? Verdict::within
             : Verdict::beyond;
}

struct CandidateCount {
  uint word;
};

Verdict judge(const CandidateCount&, const CandidateCount&, NearlyEqual&) { return Verdict::beyond; }

bool within(uvec2 a, uvec2 b, std::uint64_t limit) {
  const std::uint64_t x = std::uint64_t{a.y} << 32 | a.x, y = std::uint64_t{b.y} << 32 | b.x;
  return (x > y ? x - y : y - x) <= limit;
}

Verdict judge(const TraceCounters& cpu, const TraceCounters& gpu, NearlyEqual&) {
  const std::uint64_t rays = std::uint64_t{cpu.rays.y} << 32 | cpu.rays.x;
  const std::uint64_t steps = std::uint64_t{cpu.steps.y} << 32 | cpu.steps.x;
  const bool alike = same_bits(cpu.rays, gpu.rays) && within(cpu.hits, gpu.hits, thousandth(rays)) &&
                     within(cpu.steps, gpu.steps, steps / 100 + 64) && cpu.padding0 == gpu.padding0 &&
                     cpu.padding1 == gpu.padding1;
  return alike ? Verdict::within : Verdict::beyond;
}

Verdict judge(const vec3& cpu, const vec3& gpu, NearlyEqual&) {
  return within(cpu, gpu, colour_tolerance * std::max(largest(cpu), 1.0f)) ? Verdict::within
                                                                           : Verdict::beyond;
}

bool alike(const vec3& a, const vec3& b) {
  return within(a, b, colour_tolerance * std::max(largest(a), 1.0f));
}

bool alike(float a, float b) { return within(a, b, colour_tolerance * std::max(std::abs(a), 1.0f)); }

Verdict judge(const SurfacePoint& cpu, const SurfacePoint& gpu, NearlyEqual&) {
  const bool all = alike(cpu.normal, gpu.normal) && alike(cpu.roughness, gpu.roughness) &&
                   alike(cpu.diffuse, gpu.diffuse) && alike(cpu.ior_ratio, gpu.ior_ratio) &&
                   alike(cpu.specular, gpu.specular) && alike(cpu.transmission, gpu.transmission);
  return all ? Verdict::within : Verdict::beyond;
}

Verdict judge(const Path& cpu, const Path& gpu, NearlyEqual&) {
  const bool all = alike(cpu.throughput, gpu.throughput) && cpu.pixel == gpu.pixel &&
                   alike(cpu.pdf, gpu.pdf) && cpu.flags == gpu.flags && cpu.seed == gpu.seed &&
                   cpu.padding == gpu.padding;
  return all ? Verdict::within : Verdict::beyond;
}

Verdict judge(const float& cpu, const float& gpu, NearlyEqual&) {
  return within(cpu, gpu, noise_tolerance * std::abs(cpu)) ? Verdict::within : Verdict::beyond;
}

// Off by one code is beyond the tolerance and may happen; by more may not.
Verdict judge(const uint& cpu, const uint& gpu, NearlyEqual& result) {
  for (int shift = 0; shift < 32; shift += 8) {
    const int difference = static_cast<int>(cpu >> shift & 255) - static_cast<int>(gpu >> shift & 255);
    if (std::abs(difference) > 1) result.beyond_allowed = 0;
  }
  return Verdict::beyond;
}

template <class T>
NearlyEqual compare(std::span<const std::byte> cpu, std::span<const std::byte> gpu,
                    std::uint64_t (*beyond_allowed)(std::uint64_t)) {
  if (cpu.size() != gpu.size() || cpu.size() % sizeof(T) != 0)
    throw std::logic_error("a slot does not hold what its stage says that it does");
  NearlyEqual result;
  result.count = cpu.size() / sizeof(T);
  result.beyond_allowed = beyond_allowed(result.count);
  std::optional<std::uint64_t> first_beyond, first_tied;
  for (std::uint64_t i = 0; i < result.count; ++i) {
    T one, other;
    std::memcpy(&one, &cpu[i * sizeof(T)], sizeof(T));
    std::memcpy(&other, &gpu[i * sizeof(T)], sizeof(T));
    if (same_bits(one, other)) continue;
    ++result.differing;
    const Verdict verdict = judge(one, other, result);
    if (verdict == Verdict::beyond && result.beyond++ == 0) first_beyond = i;
    if (verdict == Verdict::tied && result.tied++ == 0) first_tied = i;
  }
  result.tied_allowed = hundredth(result.count);
  result.first = result.beyond > result.beyond_allowed || !first_tied ? first_beyond : first_tied;
  return result;
}

std::uint64_t none(std::uint64_t) { return 0; }

}  // namespace

bool rounds_like_the_host(const DeviceProperties& properties) {
  return properties.type == DeviceType::cpu &&
         properties.shared_memory;  // a CPU may be taken for a GPU, for tests
}

NearlyEqual compare_nearly(Nearly like, std::span<const std::byte> cpu, std::span<const std::byte> gpu) {
  switch (like) {
    case Nearly::rays:
      return compare<Ray>(cpu, gpu, none);
    case Nearly::hits:
      return compare<Hit>(cpu, gpu, thousandth);
    case Nearly::any_hits:
      return compare<AnyHit>(cpu, gpu, thousandth);
    case Nearly::hit_instances:
      return compare<HitInstance>(cpu, gpu, hundredth);
    case Nearly::candidates:
      return compare<BoxCandidate>(cpu, gpu, hundredth);
    case Nearly::candidate_counts:
      return compare<CandidateCount>(cpu, gpu, thousandth);
    case Nearly::counters:
      return compare<TraceCounters>(cpu, gpu, none);
    case Nearly::radiance:
      return compare<vec3>(cpu, gpu, thousandth);
    case Nearly::noise:
      return compare<float>(cpu, gpu, none);
    case Nearly::image:
      return compare<uint>(cpu, gpu, thousandth);
    case Nearly::surfaces:
      return compare<SurfacePoint>(cpu, gpu, thousandth);
    case Nearly::paths:
      return compare<Path>(cpu, gpu, thousandth);
  }
  throw std::logic_error("no such way of being nearly equal");
}

}  // namespace coppice
