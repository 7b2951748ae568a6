#include "twins/wide_packet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace coppice::twins {

namespace {

uint step_bits(const WideNode& node, int axis) { return (node.exponents >> (8 * axis) & 0xff) << 23; }

struct Box {
  vec3 box_min, box_max;
};

Box child_box(const WideNode& node, uint child) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(node.planes) + 6 * child;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = std::bit_cast<float>(step_bits(node, axis));
    box.box_min[axis] = node.origin[axis] + static_cast<float>(bytes[axis]) * step;
    box.box_max[axis] = node.origin[axis] + static_cast<float>(bytes[axis + 3]) * step;
  }
  return box;
}

}  // namespace

void Bundle::Interval::add(float x) {
  low = std::min(low, x);
  high = std::max(high, x);
}

// Products of a difference with reciprocals from `inverse`: the least.
float Bundle::least_product(float difference, const Interval& inverse) {
  return difference * (difference < 0 ? inverse.high : inverse.low);
}

void Bundle::add(const TraceRay& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    origin_[axis].add(ray.origin[axis]);
    inverse_[axis].add(ray.inverse[axis]);
    room_[axis] = std::max(room_[axis], ray.room[axis]);
  }
  t_min = std::min(t_min, ray.t_min);
}

float Bundle::reach(const WideNode& node) const {
  float distance = 0;
  uint largest_step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    distance = std::max({distance, std::fabs(node.origin[axis] - origin_[axis].low),
                         std::fabs(node.origin[axis] - origin_[axis].high)});
    largest_step = std::max(largest_step, step_bits(node, axis));
  }
  return distance + std::bit_cast<float>(largest_step) * WIDE_NODE_STEPS;
}

bool Bundle::meets(const vec3& box_min, const vec3& box_max, float reach, float leave, float& enter) const {
  enter = t_min;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval& inverse = inverse_[axis];
    const bool one_way = inverse.low > 0 || inverse.high < 0;
    if (!one_way || std::isinf(inverse.low) || std::isinf(inverse.high)) continue;
    const float below = box_min[axis] - origin_[axis].high, above = box_max[axis] - origin_[axis].low;
    const bool backward = inverse.high < 0;
    const float to_near = backward ? above : below, to_far = backward ? below : above;
    enter = std::max(enter, least_product(to_near, inverse) - room_[axis] * reach);
    leave = std::min(leave, -least_product(-to_far, inverse) + room_[axis] * reach);
  }
  return enter <= leave;
}

void WidePacket::add(const TraceRay& ray, const Sight& sight, const Hit& hit) {
  rays_.push_back(ray);
  sights_.push_back(sight);
  hits_.push_back(hit);
  bundle_.add(ray);
}

uint WidePacket::trace() {
  if (rays_.empty() || !(bundle_.t_min <= farthest())) return 0;
  uint visited = 0;
  for (std::vector<uint> stack = {0}; !stack.empty(); ++visited) {
    const uint node = stack.back();
    stack.pop_back();
    const std::vector<uint> met = visit(nodes_[node]);
    stack.insert(stack.end(), met.rbegin(), met.rend());
  }
  return visited;
}

float WidePacket::farthest() const { return std::ranges::max_element(hits_, {}, &Hit::t)->t; }

bool WidePacket::any_meets(const vec3& box_min, const vec3& box_max, float reach) const {
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    float enter;
    if (ray_meets_box_within(rays_[i], box_min, box_max, reach, hits_[i].t, enter)) return true;
  }
  return false;
}

// Tests the triangles among the children. The nodes among them that a ray meets, nearest first.
std::vector<uint> WidePacket::visit(const WideNode& node) {
  struct Met {
    uint key, child;
  };
  std::vector<Met> met;
  const float reach = bundle_.reach(node);
  for (uint child = 0; child < WIDE_CHILDREN; ++child) {
    const Box box = child_box(node, child);
    float enter;
    if (node.child[child] != WIDE_EMPTY && bundle_.meets(box.box_min, box.box_max, reach, farthest(), enter))
      met.push_back({(std::bit_cast<uint>(enter) & ~(WIDE_CHILDREN - 1)) | child, child});
  }
  std::ranges::sort(met, {}, &Met::key);
  std::vector<uint> nodes;
  for (const Met& next : met) {
    const Box box = child_box(node, next.child);
    if (!any_meets(box.box_min, box.box_max, reach)) continue;
    const uint word = node.child[next.child], triangle = word & ~WIDE_LEAF;
    if (word < WIDE_LEAF) {
      nodes.push_back(word);
      continue;
    }
    for (std::size_t i = 0; i < rays_.size(); ++i)
      if (sights_[i].sees(triangle))
        sights_[i].meet(rays_[i], triangles_[triangle], triangle, TRIANGLE_WATERTIGHT, hits_[i]);
  }
  return nodes;
}

}  // namespace coppice::twins
