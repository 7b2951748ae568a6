#pragma once

#include <limits>
#include <vector>

#include "interface/trace.h"
#include "twins/intersect.h"
#include "twins/sight.h"

namespace coppice::twins {

// The slab test for all rays of a packet at once.
class Bundle {
 public:
  void add(const TraceRay& ray);

  // A bound of how far the corners of a wide node's children are from all origins.
  float reach(const WideNode& node) const;

  // For a box within `reach` of all origins.
  bool meets(const vec3& box_min, const vec3& box_max, float reach, float leave, float& enter) const;

  float t_min = std::numeric_limits<float>::infinity();

 private:
  struct Interval {
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();

    void add(float x);
  };

  static float least_product(float difference, const Interval& inverse);

  Interval origin_[3], inverse_[3];
  float room_[3] = {};
};

// Rays that walk through a wide tree together.
class WidePacket {
 public:
  WidePacket(READS(WideNodeBuffer) nodes, READS(TriangleBuffer) triangles)
      : nodes_(nodes), triangles_(triangles) {}

  void add(const TraceRay& ray, const Sight& sight, const Hit& hit);

  // Returns how many nodes it visits.
  uint trace();

  const std::vector<TraceRay>& rays() const { return rays_; }
  const std::vector<Hit>& hits() const { return hits_; }

 private:
  float farthest() const;
  bool any_meets(const vec3& box_min, const vec3& box_max, float reach) const;
  std::vector<uint> visit(const WideNode& node);

  READS(WideNodeBuffer) nodes_;
  READS(TriangleBuffer) triangles_;
  std::vector<TraceRay> rays_;
  std::vector<Sight> sights_;
  std::vector<Hit> hits_;
  Bundle bundle_;
};

}  // namespace coppice::twins
