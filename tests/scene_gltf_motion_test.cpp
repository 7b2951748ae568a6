// What moves in a glTF file against a computation of its own: scalar code after the specification's text,
// from the numbers that the file was made of.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/input_error.h"
#include "scene/load_gltf.h"
#include "scene/motion.h"
#include "support/gltf_text.h"

namespace coppice {
namespace {

using nlohmann::json;

Scene read_moving(const std::string& text, const GltfReading& reading = {}) {
  return parse_gltf(
      text, "m.gltf", [](const std::string&) -> std::string { throw InputError("no such file"); }, reading);
}

using Numbers = std::vector<double>;

// --- The specification in scalars: row-major matrices, quaternions x y z w.

struct Matrix {
  double at[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      c.at[i][j] = 0;
      for (int k = 0; k < 4; ++k) c.at[i][j] += a.at[i][k] * b.at[k][j];
    }
  }
  return c;
}

Matrix matrix_of(const Numbers& t, const Numbers& q, const Numbers& s) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  Matrix m;
  const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m.at[i][j] = turn[i][j] * s[j];
    m.at[i][3] = t[i];
  }
  return m;
}

struct Channel {
  int node;
  std::string path, interpolation;
  std::vector<float> input, output;
  std::size_t width;
};

Numbers channel_value(const Channel& channel, double time) {
  const std::size_t keys = channel.input.size(), n = channel.width;
  const bool cubic = channel.interpolation == "CUBICSPLINE";
  const auto value = [&](std::size_t key, std::size_t part, std::size_t c) {
    return double{channel.output[cubic ? (3 * key + part) * n + c : key * n + c]};
  };
  Numbers result(n);
  std::size_t k = 0;
  while (k + 1 < keys && channel.input[k + 1] <= time) ++k;
  const bool holds = time <= channel.input[0] || k + 1 == keys || channel.interpolation == "STEP";
  if (holds) {
    for (std::size_t c = 0; c < n; ++c) result[c] = value(k, 1, c);
  } else {
    const double td = double{channel.input[k + 1]} - channel.input[k], t = (time - channel.input[k]) / td;
    double dot = 0;
    for (std::size_t c = 0; c < n; ++c) dot += value(k, 1, c) * value(k + 1, 1, c);
    const double a = std::acos(std::min(std::abs(dot), 1.0)), sign = dot < 0 ? -1 : 1;
    for (std::size_t c = 0; c < n; ++c) {
      const double v0 = value(k, 1, c), v1 = value(k + 1, 1, c);
      if (cubic) {
        const double b0 = value(k, 2, c), a1 = value(k + 1, 0, c);
        result[c] = (2 * t * t * t - 3 * t * t + 1) * v0 + td * (t * t * t - 2 * t * t + t) * b0 +
                    (-2 * t * t * t + 3 * t * t) * v1 + td * (t * t * t - t * t) * a1;
      } else if (channel.path == "rotation" && a > 1e-6) {
        result[c] = std::sin(a * (1 - t)) / std::sin(a) * v0 + sign * std::sin(a * t) / std::sin(a) * v1;
      } else {
        result[c] = (1 - t) * v0 + t * v1;
      }
    }
  }
  if (channel.path == "rotation") {
    double square = 0;
    for (const double x : result) square += x * x;
    for (double& x : result) x /= std::sqrt(square);
  }
  return result;
}

// --- A file: a chain of four nodes, of which the last three are joints, a skinned mesh with two morph
// targets beside it, and a rigid mesh below the second joint.

class SampleFile {
 public:
  explicit SampleFile(std::uint32_t seed) : random_(seed) {
    text_.json["scenes"] = {{{"nodes", {0, 4}}}};
    for (int i = 0; i < 6; ++i) {
      nodes_.push_back({numbers(3), unit(), {draw(0.5f, 2), draw(0.5f, 2), draw(0.5f, 2)}});
      const auto& [t, q, s] = nodes_.back();
      text_.json["nodes"].push_back({{"translation", t}, {"rotation", q}, {"scale", s}});
    }
    const int parents[] = {-1, 0, 1, 2, -1, 2};
    for (int i = 0; i < 6; ++i) {
      parents_.push_back(parents[i]);
      if (parents[i] >= 0) text_.json["nodes"][static_cast<std::size_t>(parents[i])]["children"].push_back(i);
    }
    add_meshes();
    std::vector<float> inverse = floats(3 * 16);
    for (std::size_t m = 0; m < 3; ++m) {
      for (std::size_t k = 0; k < 4; ++k) inverse[16 * m + 4 * k + 3] = k == 3 ? 1.0f : 0.0f;
    }
    inverse_ = inverse;
    text_.json["skins"] = {{{"joints", {1, 2, 3}}, {"inverseBindMatrices", text_.floats("MAT4", inverse)}}};
    const char* const how[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    for (int node = 0; node < 4; ++node) {
      add_channel(node, "translation", how[node % 3], 3);
      add_channel(node, "rotation", how[(node + 1) % 3], 4);
      add_channel(node, "scale", how[(node + 2) % 3], 3);
    }
    add_channel(4, "weights", how[seed % 3], 2);
  }

  std::string text() { return text_.embedded(); }
  double duration() const { return duration_; }

  std::vector<Numbers> positions_at(double time) const {
    std::vector<Matrix> global(6);
    for (std::size_t i = 0; i < 6; ++i) {
      auto [t, q, s] = nodes_[i];
      for (const Channel& channel : channels_) {
        if (channel.node != static_cast<int>(i)) continue;
        if (channel.path == "translation") t = channel_value(channel, time);
        if (channel.path == "rotation") q = channel_value(channel, time);
        if (channel.path == "scale") s = channel_value(channel, time);
      }
      const Matrix own = matrix_of(t, q, s);
      global[i] = parents_[i] < 0 ? own : product(global[static_cast<std::size_t>(parents_[i])], own);
    }
    const Numbers weights = channel_value(channels_.back(), time);
    std::vector<Numbers> result;
    for (std::size_t v = 0; v < VERTICES; ++v) {  // node 5, rigid, comes first: depth first from node 0
      result.push_back(moved(global[5], {rigid_[3 * v], rigid_[3 * v + 1], rigid_[3 * v + 2]}));
    }
    for (std::size_t v = 0; v < VERTICES; ++v) {
      Numbers p(3), sum(3);
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] =
            skinned_[3 * v + c] + weights[0] * targets_[0][3 * v + c] + weights[1] * targets_[1][3 * v + c];
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t joint = joints_[4 * v + k];
        Matrix bind;
        for (std::size_t i = 0; i < 16; ++i) bind.at[i % 4][i / 4] = inverse_[16 * joint + i];
        const Numbers q = moved(product(global[joint + 1], bind), p);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weights_[4 * v + k] * q[c];
      }
      result.push_back(sum);
    }
    return result;
  }

 private:
  static constexpr std::size_t VERTICES = 12;

  static Numbers moved(const Matrix& m, const Numbers& p) {
    Numbers result(3);
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = m.at[i][0] * p[0] + m.at[i][1] * p[1] + m.at[i][2] * p[2] + m.at[i][3];
    }
    return result;
  }
  float draw(float low, float high) {
    return low + (high - low) * static_cast<float>(random_() >> 8) * 0x1p-24f;
  }
  std::vector<float> floats(std::size_t count) {
    std::vector<float> result(count);
    for (float& x : result) x = draw(-1, 1);
    return result;
  }
  Numbers numbers(std::size_t count) {
    const std::vector<float> drawn = floats(count);
    return {drawn.begin(), drawn.end()};
  }
  Numbers unit() {
    Numbers q = numbers(4);
    double square = 0;
    for (const double x : q) square += x * x;
    for (double& x : q) x /= std::sqrt(square);
    return q;
  }

  void add_meshes() {
    rigid_ = floats(3 * VERTICES);
    skinned_ = floats(3 * VERTICES);
    for (auto& target : targets_) target = floats(3 * VERTICES);
    for (std::size_t v = 0; v < VERTICES; ++v) {
      float sum = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        joints_.push_back(static_cast<std::uint16_t>(random_() % 3));
        weights_.push_back(v % 3 == 0 && k > 1 ? 0.0f : draw(0.1f, 1));
        sum += weights_.back();
      }
      for (std::size_t k = 0; k < 4; ++k) weights_[4 * v + k] /= sum;
    }
    const json positions = {{"POSITION", text_.floats("VEC3", skinned_)},
                            {"JOINTS_0", text_.shorts("VEC4", joints_)},
                            {"WEIGHTS_0", text_.floats("VEC4", weights_)}};
    const json targets = {{{"POSITION", text_.floats("VEC3", targets_[0])}},
                          {{"POSITION", text_.floats("VEC3", targets_[1])}}};
    text_.json["meshes"] = {
        {{"primitives", {{{"attributes", positions}, {"targets", targets}}}}},
        {{"primitives", {{{"attributes", {{"POSITION", text_.floats("VEC3", rigid_)}}}}}}}};
    text_.json["nodes"][4]["mesh"] = 0;
    text_.json["nodes"][4]["skin"] = 0;
    text_.json["nodes"][5]["mesh"] = 1;
  }

  void add_channel(int node, const std::string& path, const std::string& how, std::size_t width) {
    Channel channel{node, path, how, {}, {}, width};
    float time = draw(0, 0.5f);
    for (int key = 0; key < 4; ++key) channel.input.push_back(time += draw(0.1f, 1));
    duration_ = std::max(duration_, double{time});
    const std::size_t parts = how == "CUBICSPLINE" ? 3 : 1;
    for (std::size_t i = 0; i < 4 * parts; ++i) {
      const Numbers value = path == "rotation" ? unit() : numbers(width);
      channel.output.insert(channel.output.end(), value.begin(), value.end());
    }
    json& animation = text_.json["animations"][0];
    const char* const type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    const std::size_t sampler = animation["samplers"].size();
    animation["samplers"].push_back({{"input", text_.floats("SCALAR", channel.input)},
                                     {"output", text_.floats(type, channel.output)},
                                     {"interpolation", how}});
    animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
    channels_.push_back(std::move(channel));
  }

  std::mt19937 random_;
  GltfText text_;
  std::vector<std::tuple<Numbers, Numbers, Numbers>> nodes_;
  std::vector<int> parents_;
  std::vector<float> rigid_, skinned_, targets_[2], weights_, inverse_;
  std::vector<std::uint16_t> joints_;
  std::vector<Channel> channels_;
  double duration_ = 0;
};

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
