#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/environment.h"
#include "scene/texture_map.h"

namespace coppice {

// What a surface is made of, in the terms of the MTL format. Colours are linear RGB, unbounded for emission.
struct Material {
  std::string name = "default";
  glm::vec3 diffuse{0.7f};           // Kd; of all light, the ambient too
  glm::vec3 specular{0.0f};          // Ks
  glm::vec3 emission{0.0f};          // Ke
  float shininess = 1.0f;            // Ns, the Phong exponent
  float opacity = 1.0f;              // d, or 1 - Tr; 0 is invisible, 1 is solid
  float index_of_refraction = 1.0f;  // Ni
  glm::vec3 filter{1.0f};            // Tf, of what goes through
  int illum = 1;                     // illumination model, 0 to 10
  bool is_unlit = false;             // emission is its colour, and lights nothing
  std::optional<float> roughness{};  // Pr, from 0 to 1
  std::optional<float> metallic{};   // Pm, from 0 to 1
  // Maps (scene/material_maps.h). Each multiplies what it is a map of; the last two of a material without
  // that number are it.
  TextureMap diffuse_map{};             // map_Kd
  TextureMap opacity_map{};             // map_d
  TextureMap emission_map{};            // map_Ke
  TextureMap bump_map{};                // map_Bump, heights
  TextureMap normal_map{};              // norm, directions in the tangent space of glTF
  TextureMap roughness_map{};           // map_Pr
  TextureMap metallic_map{};            // map_Pm
  std::optional<float> alpha_cutoff{};  // below it in opacity_map nothing is there, above it is solid

  bool operator==(const Material&) const = default;
};

// A light infinitely far away.
struct DirectionalLight {
  glm::vec3 direction{0.426401f, 0.852803f, 0.301511f};  // unit length, from the surface towards the light
  glm::vec3 radiance{1.0f};                              // linear RGB
  bool shadows = false;                                  // whether it casts them
};

// One of any number of lights beside the directional one.
struct Light {
  bool is_point = false;
  glm::vec3 place{0.0f, 1.0f, 0.0f};  // of a point where it is, else unit length, towards the light
  glm::vec3 radiance{1.0f};           // linear RGB; of a point at `distance`
  float distance = 1.0f;              // of a point, whose light falls off with the square; the file's unit
  bool shadows = false;
  std::string origin;  // what the file calls it, such as "/lights/0"
};

// A pinhole camera. `up` need be neither unit length nor orthogonal to the line of sight, only not parallel
// to it.
struct Camera {
  glm::vec3 position{0.0f, 0.0f, 1.0f};
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov_degrees = 40.0f;
};

// A thin lens in the place of the pinhole, whichever camera looks.
struct Lens {
  float aperture = 0.0f;  // diameter, in units of the scene; 0: a pinhole
  float focus = 0.0f;     // depth along the line of sight that is sharp; 0: that of the camera's target
  std::string origin;     // what the aperture is of, such as "/camera/aperture"
};

// Things that are near keep ambient light off.
struct AmbientOcclusion {
  float distance = 0.0f;  // how near, in units of the scene; 0: OCCLUSION_SHARE of the scene's diagonal
};

inline constexpr double OCCLUSION_SHARE = 0.05;

// The same everywhere in a box: scatters light, and absorbs it.
struct FogBox {
  glm::vec3 min{0.0f}, max{0.0f};  // none above the other
};
struct Fog {
  float density = 0.0f;       // extinction along a unit of the scene; positive
  glm::vec3 albedo{1.0f};     // of what is taken from a ray the part that is scattered, 0 to 1
  float anisotropy = 0.0f;    // mean cosine of the angle of scattering, -0.95 to 0.95
  std::optional<FogBox> box;  // none: that of the triangles
  std::string origin;         // what the file calls it
};

// Of a corner without texture coordinates, or without a normal.
inline constexpr std::uint32_t NO_ATTRIBUTE = ~0u;

struct Motion;  // scene/motion.h

// Triangles that follow each other in a scene and are seen where instances of them are.
struct InstancedMesh {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  // Of one that deforms: its vertices follow each other, too, and the motion is theirs alone, in the space of
  // the mesh. Null: they stand still.
  std::uint32_t first_vertex = 0;
  std::shared_ptr<const Motion> motion{};
};

// A mesh in its place, see scene/instances.h.
struct Instance {
  std::uint32_t mesh = 0;       // into Scene::meshes; always in range
  glm::mat4x3 transform{1.0f};  // from the space of the mesh to the scene; any floats
};

// All instances of a scene move: around the axis y, each at a speed of its own, turning on the way
// (MoveInstancesArgs). At second 0 they are where Instance::transform has them.
struct Swarm {
  std::uint32_t seed = 1;
  double seconds = 32;            // a whole cycle; positive
  double frames_per_second = 30;  // that the scene asks for; positive
};

// An indexed triangle mesh with what it takes to light and see it. +y is up; the unit of length is the
// scene's own. Coordinates may be non-finite: a triangle with such a vertex is inactive, kept here and left
// out of every tree.
struct Scene {
  std::string name;
  std::vector<glm::vec3> positions;
  // How they came from the file's coordinates, in this order (to_scene):
  glm::dvec3 offset{0.0};                     // subtracted, see load_obj
  glm::mat3 turn{1.0f};                       // then turned, see stand_up
  int scale_exponent = 0;                     // and multiplied by 2^scale_exponent, see bring_into_range
  std::vector<glm::uvec3> indices;            // one per triangle, into positions; always in range
  std::vector<std::uint32_t> material_index;  // one per triangle, into materials; always in range
  // What corners have beside their places (scene/corner_attributes.h). The index vectors are empty or have
  // one element a triangle, each corner's in range or NO_ATTRIBUTE. Texture coordinates are as in the file,
  // any floats; how they lie on an image is in TextureMap.
  std::vector<glm::vec2> texcoords;
  std::vector<glm::uvec3> texcoord_index;
  // In the space of the positions, of any length, also 0 or not finite. What moves by its vertices has none.
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> normal_index;
  // With instances only these are seen, and all triangles belong to meshes; without, the triangles as they
  // are.
  std::vector<InstancedMesh> meshes;
  std::vector<Instance> instances;
  std::optional<Swarm> swarm;                      // none: the instances stand still
  std::vector<Material> materials = {Material{}};  // never empty
  std::optional<Camera> camera;                    // absent: frame_scene chooses one
  Lens lens;
  // Of the faces of an OBJ or PLY file, before they are cut into triangles (FaceDigest); 0 of others.
  std::uint64_t face_digest = 0;
  DirectionalLight light;
  std::string light_origin;                   // what the file calls it; empty for the default one
  std::vector<Light> more_lights;             // at most MAX_LIGHTS - 1
  glm::vec3 ambient_light{0.35f};             // linear RGB, multiplies Material::diffuse
  std::optional<AmbientOcclusion> occlusion;  // none: it reaches everything
  std::optional<Environment> environment;     // none: a background that lights nothing
  std::optional<Fog> fog;                     // none: clear air
  bool global_illumination = false;           // whether light goes on from diffuse surfaces
  std::uint32_t bounces = 4;                  // of paths at most, beside the camera's rays
  // Null: nothing moves but a swarm. With instances it has no vertices: these are in InstancedMesh::motion.
  std::shared_ptr<const Motion> motion;
  std::vector<std::string> warnings;  // one line each, what was odd about the input but not fatal
};

// Between two opposite corners.
FogBox fog_box(const glm::vec3& corner, const glm::vec3& opposite);

// The scene's lights, in this order: the first directional one becomes Scene::light, if there is one.
void set_lights(Scene& scene, std::vector<Light> lights);

// Number of triangles with at least one non-finite vertex coordinate.
std::uint32_t count_inactive(const Scene& scene);

// Tracing multiplies up to three lengths in float. A scene whose largest active coordinate is not 0 and not
// from 2^-30 to 2^30 is brought to [2^30, 2^31) by a power of two, which changes neither its shape nor its
// tree; coordinates below 2^-179 of the largest are lost. Its camera and its points of light come along.
void bring_into_range(Scene& scene);

inline constexpr std::array<std::string_view, 6> UP_AXES = {"x", "y", "z", "-x", "-y", "-z"};

// Turns the scene so that the axis `up`, one of UP_AXES, becomes +y. With z up, the file's y then points away
// from the default camera, as north on a map. But for "y" the scene's own camera and lens are dropped. The
// directional light stays where it is, the others turn with the scene, and normals of what has no instances.
void stand_up(Scene& scene, std::string_view up);

// A point or a direction of the file, as its user knows it, in the scene, and a point of the scene in the
// file.
glm::dvec3 to_scene(const Scene& scene, glm::dvec3 point);
glm::dvec3 direction_to_scene(const Scene& scene, glm::dvec3 direction);
glm::dvec3 to_file(const Scene& scene, glm::dvec3 point);
glm::dvec3 direction_to_file(const Scene& scene, glm::dvec3 direction);

// The scene's own camera where it has one, else one that sees all triangles from a three-quarter view a bit
// above them: active ones with an area, all active ones where none has. `aspect` is width / height,
// positive. Every member of the result is finite and position differs from target, for every scene: empty, a
// single point, extents from 1e-38 to 3e38, anywhere. (A camera cannot stand outside of a scene that fills
// the range of float: there it stands at the edge of the range.)
Camera frame_scene(const Scene& scene, float aspect);

}  // namespace coppice
