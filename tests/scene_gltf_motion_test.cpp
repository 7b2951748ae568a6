// What moves in a glTF file against a computation of its own: scalar code after the specification's text,
// from the numbers that the file was made of.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/input_error.h"
#include "scene/load_gltf.h"
#include "scene/motion.h"
#include "support/gltf_sample.h"
#include "support/gltf_text.h"

namespace coppice {
namespace {

using nlohmann::json;

Scene read_moving(const std::string& text, const GltfReading& reading = {}) {
  return parse_gltf(
      text, "m.gltf", [](const std::string&) -> std::string { throw InputError("no such file"); }, reading);
}

void expect_positions(const std::vector<glm::vec3>& got, const std::vector<Numbers>& expected, double time) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t v = 0; v < got.size(); ++v) {
    double reach = 1;
    for (const double x : expected[v]) reach = std::max(reach, std::abs(x));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(got[v][c], expected[v][static_cast<std::size_t>(c)], 1e-5 * reach)
          << "vertex " << v << " at " << time;
    }
  }
}

TEST(GltfMotion, SkinsMorphTargetsAndNodesAgainstTheSpecification) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    SampleFile sample(seed);
    const Scene scene = read_moving(sample.text());
    ASSERT_TRUE(scene.motion);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_NEAR(scene.motion->duration_seconds, sample.duration(), 1e-9);
    expect_positions(scene.positions, sample.positions_at(0), 0);
    for (int i = 0; i <= 20; ++i) {
      const double time = sample.duration() * i / 20;
      expect_positions(positions_at(*scene.motion, time), sample.positions_at(time), time);
      EXPECT_FALSE(HasFailure()) << seed;
    }
    const double later = 0.3 * sample.duration();
    expect_positions(positions_at(*scene.motion, later + 3 * sample.duration()), sample.positions_at(later),
                     later);
  }
}

TEST(GltfMotion, WithoutAnAnimationSkinsAndTargetsAreAppliedOnce) {
  SampleFile sample(5);
  json text = json::parse(sample.text());
  text.erase("animations");
  text["nodes"][4]["weights"] = {0.25, -0.5};
  const Scene scene = read_moving(text.dump());
  EXPECT_EQ(scene.motion, nullptr);
  text["nodes"][4].erase("weights");
  text["meshes"][0]["weights"] = {0.25, -0.5};
  EXPECT_EQ(read_moving(text.dump()).positions, scene.positions);
  text["meshes"][0].erase("weights");
  EXPECT_NE(read_moving(text.dump()).positions, scene.positions);
}

// Two clips for the same node, one for another.
TEST(GltfMotion, AnimationsPlayTogetherUnlessTheyMoveTheSame) {
  GltfText text = gltf_triangle();
  text.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}};
  text.json["scenes"] = {{{"nodes", {0, 1}}}};
  const int input = text.floats("SCALAR", {0, 1});
  const auto clip = [&](const char* name, int node, float to) {
    const int output = text.floats("VEC3", {0, 0, 0, to, 0, 0});
    text.json["animations"].push_back(
        {{"name", name},
         {"samplers", {{{"input", input}, {"output", output}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"path", "pointer"}}}},
           {{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
  };
  clip("walk", 0, 1);
  clip("run", 0, 10);
  clip("wave", 1, 100);
  const Scene both = read_moving(text.embedded());
  ASSERT_EQ(both.warnings.size(), 1u);
  EXPECT_EQ(
      both.warnings[0],
      "m.gltf: /animations/1: animation moves what an earlier one moves and is not played; a scene file can "
      "choose it");
  const std::vector<glm::vec3> half = positions_at(*both.motion, 0.5);
  EXPECT_EQ(half[0].x, 0.5f);
  EXPECT_EQ(half[3].x, 50.0f);
  const Scene run = read_moving(text.embedded(), {.animation = "run"});
  EXPECT_EQ(positions_at(*run.motion, 0.5)[0].x, 5.0f);
  EXPECT_EQ(positions_at(*run.motion, 0.5)[3].x, 0.0f);
  EXPECT_EQ(positions_at(*read_moving(text.embedded(), {.animation = "2"}).motion, 0.5)[3].x, 50.0f);
  try {
    read_moving(text.embedded(), {.animation = "hop"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "m.gltf: /animations: no animation 'hop', there are: 'walk', 'run', 'wave'");
  }
}

TEST(GltfMotion, ACameraThatMoves) {
  GltfText text = gltf_triangle();
  text.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  text.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"camera", 0}, {"translation", {0, 0, 4}}}};
  text.json["scenes"] = {{{"nodes", {0, 1}}}};
  const float half = std::sqrt(0.5f);
  text.json["animations"] = {
      {{"samplers",
        {{{"input", text.floats("SCALAR", {0, 2})},
          {"output", text.floats("VEC4", {0, 0, 0, 1, 0, half, 0, half})}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  const Scene scene = read_moving(text.embedded());
  ASSERT_TRUE(scene.motion && scene.camera);
  EXPECT_EQ(scene.camera->position, glm::vec3(0, 0, 4));
  const Pose end = pose_at(*scene.motion, 2);
  ASSERT_TRUE(end.camera.has_value());
  EXPECT_LT(glm::distance(end.camera->position, glm::vec3(4, 0, 0)), 1e-5f);
  EXPECT_LT(end.camera->target.x, 1);
  EXPECT_EQ(positions_at(*scene.motion, 2), scene.positions);
}

TEST(GltfMotion, InfluencesBeyondFourAreLeftOutAndSaid) {
  SampleFile sample(3);
  json text = json::parse(sample.text());
  json& attributes = text["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = attributes["JOINTS_0"];
  attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
  const Scene scene = read_moving(text.dump());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0],
            "m.gltf: /meshes/0/primitives/0: vertices with more than 4 joints keep the 4 of most weight (and "
            "7 more)");
  for (const glm::vec4 weights : scene.motion->weights) {
    EXPECT_NEAR(weights.x + weights.y + weights.z + weights.w, 1, 1e-6);
  }
}

TEST(GltfMotion, EveryErrorNamesItsPlace) {
  struct Fault {
    const char* pointer;
    json value;
    const char* says;
  };
  const std::vector<Fault> faults = {
      {"/skins/0/joints/1", 77, "/skins/0/joints/1: 77, expected an index below 6, the number of nodes"},
      {"/skins/0/joints", {1, 2}, "joint 2 of vertex"},
      {"/skins/0/joints", {1, 2, 3, 0}, "/count: 3, expected at least the 4 joints of /skins/0"},
      {"/skins/0/inverseBindMatrices", 0,
       "/accessors/0/type: \"VEC3\", expected \"MAT4\" for /skins/0/inverseBind"},
      {"/meshes/0/primitives/0/attributes",
       {{"POSITION", 0}},
       "/attributes: JOINTS_0 is missing, the skin needs it"},
      {"/meshes/0/primitives/0/attributes/WEIGHTS_0", 0, "/accessors/0/type: \"VEC3\", expected \"VEC4\""},
      {"/meshes/0/primitives/0/attributes/JOINTS_0", 2, "/componentType: 5126, expected 5121 or 5123"},
      {"/accessors/2/count", 11,
       "/accessors/2/count: 11, expected 12, the number of vertices of /meshes/0/prim"},
      {"/meshes/0/primitives/0/targets/0/POSITION", 40, "/targets/0/POSITION: 40, expected an index below"},
      {"/animations/0/channels/0/sampler", 99,
       "/animations/0/channels/0/sampler: 99, expected an index below 13"},
      {"/animations/0/channels/0/target/node", 6,
       "/animations/0/channels/0/target/node: 6, expected an index below 6"},
      {"/animations/0/channels/3/target/node", 0, "/channels/3/target: node 0's translation again"},
      {"/animations/0/channels/12/target/node", 3, "/channels/12/target: node 3 has no morph targets"},
      {"/animations/0/samplers/0/output", 0,
       "/accessors/0/count: 36 numbers, expected 12 for the 4 times of /anim"},
      {"/animations/0/samplers/0/interpolation", "BEZIER",
       "/interpolation: \"BEZIER\", expected \"LINEAR\", \"STEP\""},
      {"/animations/0/samplers/0/input", 3, "/accessors/3/type: \"VEC3\", expected \"SCALAR\""},
      {"/nodes/0/matrix",
       {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
       "/nodes/0/matrix: expected translation"},
  };
  SampleFile sample(4);
  const json whole = json::parse(sample.text());
  for (const auto& [pointer, value, says] : faults) {
    json broken = whole;
    broken[json::json_pointer(pointer)] = value;
    std::string message;
    try {
      read_moving(broken.dump());
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_TRUE(message.starts_with("m.gltf: /")) << pointer << ": " << message;
    EXPECT_NE(message.find(says), message.npos) << pointer << ": " << message;
  }
  GltfText text = gltf_triangle();
  const int input = text.floats("SCALAR", {0, 1, 1});
  text.json["animations"] = {
      {{"samplers", {{{"input", input}, {"output", text.floats("VEC3", std::vector<float>(9))}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
  try {
    read_moving(text.embedded());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "m.gltf: /accessors/2: time 2 is 1.000000, expected rising times of at least 0 for "
                 "/animations/0/samplers/0/input");
  }
}

}  // namespace
}  // namespace coppice
