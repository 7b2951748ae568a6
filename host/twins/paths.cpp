#include "twins/paths.h"

#include <algorithm>

#include "twins/vectors.h"

namespace coppice::twins {

uint path_dimension(uint bounce, uint use) { return bounce * PATH_DIMENSIONS + use; }

uint paths_in_queue(const Address<const uint>& count_at, uint most) {
  return count_at.value == 0 ? most : std::min(count_at[0], most);
}

float power_weight(float ratio) { return 1.0f / (1.0f + ratio * ratio); }

vec3 normal_towards(const Triangle& triangle, const vec3& direction) {
  const vec3 normal = unit_normal(triangle);
  return dot_product(normal, unit_vector(direction)) > 0 ? -normal : normal;
}

BsdfSwitches switches_of(uint lobes) {
  return {(lobes & PATH_LOBE_DIFFUSE) != 0, (lobes & PATH_LOBE_REFLECTS) != 0,
          (lobes & PATH_LOBE_TRANSMITS) != 0};
}

}  // namespace coppice::twins
