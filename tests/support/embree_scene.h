#pragma once

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "interface/types.h"

namespace coppice {

template <auto release>
struct Release {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};

// A scene of unconnected triangles in Embree, robust, of medium quality. Throws std::runtime_error.
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
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw std::runtime_error("Embree failed");
  }

  // On as many threads as the caller's arena has.
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

}  // namespace coppice
