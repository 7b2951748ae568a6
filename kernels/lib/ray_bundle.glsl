// The rays of a packet as one: intervals of their origins and reciprocal directions. Boulos, Wald and Shirley 2006,
// "Geometric and Arithmetic Culling Methods for Entire Ray Packets". Rounding is monotonic, so the interval of a slab
// test's float results holds the result of each ray, bit for bit: what a ray meets its bundle meets.

struct RayBundle {
  vec3 origin_low, origin_high;
  vec3 inverse_low, inverse_high;  // of one sign; 0 on an axis that tells nothing
  vec3 room;                       // the largest; infinite on such an axis
  float t_min;                     // the least
};

RayBundle empty_bundle() {
  vec3 infinite = uintBitsToFloat(uvec3(0x7f800000u));
  return RayBundle(infinite, -infinite, infinite, -infinite, vec3(0.0), infinite.x);
}

void add_to_bundle(TraceRay ray, inout RayBundle bundle) {
  bundle.origin_low = lesser(bundle.origin_low, ray.origin);
  bundle.origin_high = greater(bundle.origin_high, ray.origin);
  bundle.inverse_low = lesser(bundle.inverse_low, ray.inverse);
  bundle.inverse_high = greater(bundle.inverse_high, ray.inverse);
  bundle.room = greater(bundle.room, ray.room);
  bundle.t_min = lesser(bundle.t_min, ray.t_min);
}

// An axis tells something where all rays go the same way along it.
void bind_axis(inout float low, inout float high, inout float room) {
  bool one_way = (low > 0.0 || high < 0.0) && !isinf(low) && !isinf(high);
  low = one_way ? low : 0.0;
  high = one_way ? high : 0.0;
  room = one_way ? room : uintBitsToFloat(0x7f800000u);
}

// From the bundles of the invocations that of the packet.
void bind_packet(inout RayBundle bundle) {
  bundle.origin_low = packet_lesser(bundle.origin_low);
  bundle.origin_high = packet_greater(bundle.origin_high);
  bundle.inverse_low = packet_lesser(bundle.inverse_low);
  bundle.inverse_high = packet_greater(bundle.inverse_high);
  bundle.room = packet_greater(bundle.room);
  bundle.t_min = packet_lesser(bundle.t_min);
  [[unroll]] for (uint axis = 0u; axis < 3u; ++axis)
    bind_axis(bundle.inverse_low[axis], bundle.inverse_high[axis], bundle.room[axis]);
}

// The near plane's least t and the far plane's greatest. For rays that go backward the difference to the plane is
// negative, or they have passed it: the sign says which end of the reciprocals makes the product least.
void clip_bundle(float slab_min, float slab_max, float origin_low, float origin_high, float inverse_low,
                 float inverse_high, float pad, inout float enter, inout float leave) {
  bool backward = inverse_high < 0.0;
  precise float to_near = backward ? slab_max - origin_low : slab_min - origin_high;
  precise float to_far = backward ? slab_min - origin_high : slab_max - origin_low;
  precise float near = to_near * (to_near >= 0.0 ? inverse_low : inverse_high) - pad;
  precise float far = to_far * (to_far >= 0.0 ? inverse_high : inverse_low) + pad;
  if (near > enter) enter = near;
  if (far < leave) leave = far;
}

// At least what lies between the position and the farthest of the origins, in the maximum norm.
float bundle_reach(RayBundle b, vec3 position) {
  precise vec3 from_low = position - b.origin_low;
  precise vec3 from_high = position - b.origin_high;
  return largest(from_low, from_high);
}

// False only if no ray of the bundle meets the box, which is within `reach` of all origins, up to `leave`. `enter` is no
// later than where the first one does. On an axis that tells nothing the pad is infinite, or NaN if reach is 0.
bool bundle_meets_box(RayBundle b, vec3 box_min, vec3 box_max, float reach, float leave, out float enter) {
  enter = b.t_min;
  precise vec3 pad = b.room * reach;
  clip_bundle(box_min.x, box_max.x, b.origin_low.x, b.origin_high.x, b.inverse_low.x, b.inverse_high.x, pad.x,
              enter, leave);
  clip_bundle(box_min.y, box_max.y, b.origin_low.y, b.origin_high.y, b.inverse_low.y, b.inverse_high.y, pad.y,
              enter, leave);
  clip_bundle(box_min.z, box_max.z, b.origin_low.z, b.origin_high.z, b.inverse_low.z, b.inverse_high.z, pad.z,
              enter, leave);
  return enter <= leave;
}
