// Scenes far from the origin: in map coordinates (UTM), earth-centred ones (ECEF), and farther away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iomanip>
#include <iterator>
#include <sstream>

#include "analysis/cpu_tracer.h"
#include "builders/registry.h"
#include "render/frame.h"
#include "scene/load_obj.h"

namespace coppice {
namespace {

Scene parse(const std::string& text) {
  return parse_obj(text, "far.obj", [](const std::string&, MtlMatch) { return std::nullopt; });
}

std::string read(const std::string& name) {
  std::ifstream file(std::string(COPPICE_TEST_SCENES) + "/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The text with all vertices moved, written with so many digits that double loses less than 1e-6.
std::string moved(const std::string& text, glm::dvec3 by) {
  std::istringstream in(text);
  std::ostringstream out;
  out << std::fixed << std::setprecision(6);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string keyword;
    glm::dvec3 p;
    if (words >> keyword >> p.x >> p.y >> p.z && keyword == "v") {
      out << "v " << p.x + by.x << ' ' << p.y + by.y << ' ' << p.z + by.z << '\n';
    } else {
      out << line << '\n';
    }
  }
  return out.str();
}

std::size_t count_hits(const Scene& scene) {
  const std::vector<Triangle> triangles = scene_arrays(scene).triangles;
  const std::vector<Ray> rays = rays_through(make_film(scene, {}, 500, 375, 1));
  std::vector<Hit> hits(rays.size());
  trace_all(find_cpu_builder("lbvh").build(triangles, {}).nodes, triangles, rays, hits);
  return static_cast<std::size_t>(
      std::ranges::count_if(hits, [](const Hit& hit) { return hit.triangle != NO_TRIANGLE; }));
}

const glm::dvec3 PLACES[] = {{512345.25, 121.5, -5412345.75},
                             {512345.25, 5412345.75, 121.5},
                             {4200123.5, 171234.25, 4780321.125},
                             {1e7, 0, 0},
                             {0, 1e8, -1e8},
                             {1e9, 1e9, 1e9},
                             {-1e9, 3, 1},
                             {1000, 0, 0}};

TEST(FarScene, IsFramedAsAtTheOrigin) {
  EXPECT_EQ(count_hits(parse(read("house.obj"))), 47266u);
  const Scene utm = parse(read("house_utm.obj"));
  EXPECT_EQ(count_hits(utm), 47266u);
  ASSERT_EQ(utm.warnings.size(), 1u);
  EXPECT_NE(utm.warnings[0].find("512352,128,-5412336 subtracted"), std::string::npos) << utm.warnings[0];
}

TEST(FarScene, LosesNoDetail) {
  const std::string text = read("house.obj");
  const Scene near = parse(text);
  EXPECT_EQ(near.offset, glm::dvec3(0));
  const Camera near_camera = frame_scene(near, 1.5f);
  for (const glm::dvec3 place : PLACES) {
    const Scene scene = parse(moved(text, place));
    ASSERT_EQ(scene.positions.size(), near.positions.size());
    EXPECT_NE(scene.offset, glm::dvec3(0));
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
      const glm::dvec3 there = to_file(scene, scene.positions[i]) - place;
      ASSERT_LE(glm::length(there - glm::dvec3(near.positions[i])), 2e-6) << place.x << ' ' << i;
    }
    const Camera camera = frame_scene(scene, 1.5f);
    EXPECT_LE(glm::length(to_file(scene, camera.position) - place - glm::dvec3(near_camera.position)), 1e-5);
    EXPECT_LE(glm::length(to_file(scene, camera.target) - place - glm::dvec3(near_camera.target)), 1e-5);
  }
}

// Polygons are cut where their corners are, not where float would put them.
TEST(FarScene, CutsSmallPolygonsRight) {
  const std::string text = "v 0.04 0 0\nv 0.01 0.01 0\nv 0 0.04 0\nv 0 0 0\nf 1 2 3 4\n";
  for (const glm::dvec3 place : PLACES) {
    const Scene scene = parse(moved(text, place));
    double sum = 0;
    for (const glm::uvec3 t : scene.indices) {
      const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
      sum += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    EXPECT_NEAR(sum, 4e-4, 1e-6) << place.x;
  }
}

TEST(FarScene, NeedsNoOffsetNearTheOriginForItsSize) {
  const std::string text = read("house.obj");
  for (const glm::dvec3 place : {glm::dvec3{0}, glm::dvec3{20, 0, 0}, glm::dvec3{-50, 0.5, 100}}) {
    EXPECT_EQ(parse(moved(text, place)).offset, glm::dvec3(0));
  }
  EXPECT_EQ(parse("v 900 900 900\nv 1000 900 900\nv 900 1000 900\nf 1 2 3\n").offset, glm::dvec3(0));
}

TEST(FarScene, GoesByWhatIsSeen) {
  const std::string text = read("house.obj");
  const Camera expected = frame_scene(parse(text), 1.5f);
  for (const char* stray : {"v 1e7 0 0\n", "v 1e7 0 0\nf -1 -1 -1\n", "v 1e7 0 0\nf -1 1 -1\n",
                            "v 1e7 0 0\nv 1e8 0 0\nv 3e7 0 0\nf -1 -2 -3\n", "v 0 nan 1e9\nf 1 2 -1\n"}) {
    const Scene scene = parse(text + stray);
    EXPECT_EQ(scene.offset, glm::dvec3(0)) << stray;
    EXPECT_EQ(frame_scene(scene, 1.5f).position, expected.position) << stray;
    const Scene utm = parse(moved(text, PLACES[0]) + stray);
    EXPECT_NE(utm.offset, glm::dvec3(0)) << stray;
    const glm::dvec3 there = to_file(utm, frame_scene(utm, 1.5f).position) - PLACES[0];
    EXPECT_LE(glm::length(there - glm::dvec3(expected.position)), 1e-5) << stray;
  }
}

TEST(FarScene, WithoutExtentStillHasACamera) {
  for (const char* text : {"v 5e6 5e6 5e6\nf 1 1 1\n", "v 5e6 0 0\nv 5e6 1e-12 0\nv 5e6 0 1e-12\nf 1 2 3\n",
                           "v 1e300 0 0\nv 1 1e300 0\nv 0 0 1e300\nf 1 2 3\n"}) {
    const Camera camera = frame_scene(parse(text), 1);
    EXPECT_NE(camera.position, camera.target) << text;
  }
}

}  // namespace
}  // namespace coppice
