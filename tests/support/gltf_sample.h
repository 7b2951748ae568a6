#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "support/gltf_text.h"

// A glTF file that moves, and where its vertices are: scalar code after the specification's text, from the
// numbers that the file was made of, without anything of the reader.
namespace coppice {

using Numbers = std::vector<double>;

// --- The specification in scalars: row-major matrices, quaternions x y z w.

struct Matrix {
  double at[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
};

inline Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      c.at[i][j] = 0;
      for (int k = 0; k < 4; ++k) c.at[i][j] += a.at[i][k] * b.at[k][j];
    }
  }
  return c;
}

inline Matrix matrix_of(const Numbers& t, const Numbers& q, const Numbers& s) {
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

inline Numbers channel_value(const Channel& channel, double time) {
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
    const nlohmann::json positions = {{"POSITION", text_.floats("VEC3", skinned_)},
                                      {"JOINTS_0", text_.shorts("VEC4", joints_)},
                                      {"WEIGHTS_0", text_.floats("VEC4", weights_)}};
    const nlohmann::json targets = {{{"POSITION", text_.floats("VEC3", targets_[0])}},
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
    nlohmann::json& animation = text_.json["animations"][0];
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

}  // namespace coppice
