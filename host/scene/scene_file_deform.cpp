#include "scene/scene_file_deform.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/bounds.h"
#include "scene/corner_attributes.h"
#include "scene/json_check.h"
#include "scene/scene_compose.h"
#include "scene/scene_file_tracks.h"

namespace coppice {

Deformation read_deformation(const nlohmann::json& from, Scene& mesh, const std::string& name,
                             const std::string& pointer) {
  Deformation deformation;
  const std::string kind = from["kind"].get<std::string>();
  const auto& kinds = {"wave", "twist", "explode", "swarm", "sway"};
  deformation.kind = static_cast<DeformKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
  const bool in_pieces = kind == "explode" || kind == "swarm";
  if (!in_pieces && from.contains("piece_triangles")) {
    fail_at(name, pointer + "/piece_triangles", "does not go with \"" + kind + "\"");
  }
  if (in_pieces) {
    if (mesh.motion) {
      fail_at(name, pointer + "/kind", "\"" + kind + "\" needs vertices that no animation moves");
    }
    unshare_vertices(mesh);
    deformation.piece_vertices = 3 * from.value("piece_triangles", 1u);
  }
  const Bounds bounds = visible_bounds(mesh);
  glm::dvec3 centre = bounds.centre();
  if (kind == "sway" && !bounds.empty()) centre.y = bounds.low.y;
  deformation.centre = from.contains("centre") ? vector_of(from["centre"]) : glm::vec3(centre);
  const double extent = std::isfinite(bounds.extent()) && bounds.extent() > 0 ? bounds.extent() : 1.0;
  deformation.size = from.value("size", static_cast<float>(std::min(extent, 1e38)));
  const double amounts[] = {0.1, 0.25, 1, 0.1, 0.1};
  deformation.amount =
      from.value("amount", static_cast<float>(amounts[static_cast<std::size_t>(deformation.kind)]));
  deformation.seconds = from.value("seconds", deformation.seconds);
  deformation.vertices = {0, static_cast<std::uint32_t>(mesh.positions.size())};
  return deformation;
}

void add_deformation(Scene& mesh, const Deformation& deformation) {
  if (mesh.positions.empty()) return;
  Motion motion = motion_of(mesh);
  motion.duration_seconds =
      mesh.motion ? std::max(motion.duration_seconds, double{deformation.seconds}) : deformation.seconds;
  motion.deformations.push_back(deformation);
  mesh.positions = positions_at(motion, 0);
  mesh.motion = std::make_shared<Motion>(std::move(motion));
  drop_normals(mesh);
}

}  // namespace coppice
