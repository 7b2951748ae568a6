#include "scene/surface_effects.h"

#include <algorithm>
#include <glm/vector_relational.hpp>

namespace coppice {

bool is_emitter(const Material& material) {
  return !material.is_unlit && !material.emission_map &&
         glm::any(glm::greaterThan(material.emission, glm::vec3(0)));
}

float metalness_of(const Material& material) {
  return material.metallic_map ? 0 : std::clamp(material.metallic.value_or(0), 0.0f, 1.0f);
}

bool is_reflecting(const Material& material) {
  if (metalness_of(material) > 0) return true;
  return !material.metallic_map && material.illum >= 3 && material.illum <= 7 &&
         glm::any(glm::greaterThan(material.specular, glm::vec3(0)));
}

float transmission_of(const Material& material) {
  const float through = std::clamp(1 - material.opacity, 0.0f, 1.0f);
  if (material.illum == 4) return through;
  if (material.illum != 6 && material.illum != 7) return 0;
  return through > 0 ? through : 1;
}

}  // namespace coppice
