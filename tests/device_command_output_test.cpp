// What the program writes of a picture: linear radiance beside pixels.
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "support/command.h"
#include "support/read_exr.h"
#include "support/read_png.h"

namespace coppice {
namespace {

// The 8-bit sRGB code of a channel (IEC 61966-2-1).
int code_of(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<int>(std::floor(encoded * 255 + 0.5));
}

// Of radiance, by how many codes the pixels are off at most.
int largest_difference(const ReadExr& radiance, const ReadPng& picture) {
  int largest = 0;
  for (std::size_t i = 0; i < radiance.rgb.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel)
      largest = std::max(largest, std::abs(code_of(radiance.rgb[i][channel]) -
                                           static_cast<int>(picture.rgba8[i] >> (8 * channel) & 255)));
  }
  return largest;
}

TEST_F(Command, AnExrHoldsTheRadianceOfThePng) {
  for (const char* tracer : {" --tracer gpu", " --tracer cpu", " --tree binary --builder sah"}) {
    for (const char* samples : {"", " --spp 5"}) {
      const std::string arguments = std::string("render terrain:500 --size 53x37") + tracer + samples;
      const Outcome exr = run(arguments + " -o a.EXR --json e.json"),
                    png = run(arguments + " -o a.png --json p.json");
      ASSERT_EQ(exr.status, 0) << arguments << ": " << exr.err;
      ASSERT_EQ(png.status, 0) << arguments << ": " << png.err;
      const ReadExr radiance = read_exr("a.EXR");
      EXPECT_EQ(radiance.width, 53u);
      EXPECT_EQ(radiance.height, 37u);
      EXPECT_EQ(largest_difference(radiance, read_png("a.png")), 0) << arguments;
      EXPECT_EQ(nlohmann::json::parse(read("e.json"))["image_hash"],
                nlohmann::json::parse(read("p.json"))["image_hash"]);
    }
  }
}

// An exposure of 3 stops is radiance times 8, cut off at 1; a tone curve leaves less of it cut off.
TEST_F(Command, TonesAreMappedFromRadiance) {
  const std::string arguments = "render terrain:500 --size 53x37";
  ASSERT_EQ(run(arguments + " -o a.exr").status, 0);
  const Outcome exposed = run(arguments + " -o exposed.png --exposure 3 --json a.json");
  const Outcome mapped = run(arguments + " -o mapped.png --exposure +3 --tonemap aces --json b.json");
  ASSERT_EQ(exposed.status, 0) << exposed.err;
  ASSERT_EQ(mapped.status, 0) << mapped.err;
  ReadExr radiance = read_exr("a.exr");
  for (glm::vec3& colour : radiance.rgb) colour *= 8.0f;
  const ReadPng cut_off = read_png("exposed.png"), curved = read_png("mapped.png");
  EXPECT_EQ(largest_difference(radiance, cut_off), 0);
  const auto white = [](const ReadPng& picture) { return std::ranges::count(picture.rgba8, 0xffffffffu); };
  EXPECT_GT(white(cut_off), white(curved));
  EXPECT_EQ(nlohmann::json::parse(read("a.json"))["exposure"], 3);
  EXPECT_EQ(nlohmann::json::parse(read("b.json"))["tonemap"], "aces");
  for (const char* given : {"nan", "inf", "65", "1e9", "x", "''", "1,2"})
    expect_refused("render one.obj -o out.png --exposure " + std::string(given), 2, "--exposure");
  expect_refused("render one.obj -o out.png --tonemap filmic", 2, "--tonemap");
  expect_refused("render one.obj -o out.exr --tonemap aces", 2, "--tonemap");
  expect_refused("render one.obj -o out.png --show depth --exposure 1", 2, "--exposure");
}

TEST_F(Command, TonesAreMappedInLockstepAndInMotion) {
  const Outcome lockstep =
      run("lockstep terrain:500 --size 32x24 --tonemap reinhard --exposure -1.5 --json -");
  ASSERT_EQ(lockstep.status, 0) << lockstep.err;
  const auto hash_with = [&](const std::string& options) {
    const Outcome animated = run("animate moving:5000 --frames 1 --size 32x24 --json -" + options);
    EXPECT_EQ(animated.status, 0) << animated.err;
    return nlohmann::json::parse(animated.out)["frame_hashes"][0].get<std::string>();
  };
  EXPECT_NE(hash_with(" --tonemap aces"), hash_with(""));
}

TEST_F(Command, APictureIsRefinedUntilItsErrorIsReached) {
  const auto report_of = [](const std::string& options) {
    const Outcome outcome = run("render terrain:500 --size 53x37 -o p.png --json -" + options);
    EXPECT_EQ(outcome.status, 0) << options << ": " << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const auto coarse = report_of(" --error 0.05"), fine = report_of(" --error 0.02");
  EXPECT_EQ(fine["refined"]["ended_by"], "error");
  EXPECT_LE(fine["refined"]["error"].get<double>(), 0.02);
  EXPECT_GT(fine["refined"]["error"].get<double>(), 0.01);
  EXPECT_GT(fine["spp"].get<int>(), coarse["spp"].get<int>());
  EXPECT_EQ(fine["rays"]["primary"].get<int>(), 53 * 37 * fine["spp"].get<int>());
  EXPECT_FALSE(report_of(" --spp 4").contains("refined"));
  // However it ends, as many samples are the same picture; the first is that of one sample.
  const std::string spp = " --spp " + std::to_string(fine["spp"].get<int>());
  EXPECT_EQ(report_of(" --error 1e-9 --validate" + spp)["image_hash"], fine["image_hash"]);
  const auto one = report_of(" --seconds 1e-9");
  EXPECT_EQ(one["spp"], 1);
  EXPECT_EQ(one["refined"]["ended_by"], "seconds");
  EXPECT_TRUE(one["refined"]["error"].is_null());
  EXPECT_EQ(one["image_hash"], report_of("")["image_hash"]);
  const auto by_host = report_of(" --error 0.05 --tracer cpu");
  EXPECT_EQ(by_host["spp"], coarse["spp"]);
  EXPECT_EQ(by_host["image_hash"], coarse["image_hash"]);
}

TEST_F(Command, ARefinedPictureMayBeAnExrAndSaysWhatItReached) {
  const Outcome exr = run("render terrain:500 --size 53x37 -o a.exr --error 0.05"),
                png = run("render terrain:500 --size 53x37 -o a.png --error 0.05");
  ASSERT_EQ(exr.status, 0) << exr.err;
  ASSERT_EQ(png.status, 0) << png.err;
  EXPECT_EQ(largest_difference(read_exr("a.exr"), read_png("a.png")), 0);
  EXPECT_NE(png.out.find("relative error 0.0"), std::string::npos) << png.out;
  for (const char* given : {"0", "-1", "nan", "inf", "x", "''"}) {
    expect_refused("render one.obj -o out.png --seconds=" + std::string(given), 2, "--seconds");
    expect_refused("render one.obj -o out.png --error=" + std::string(given), 2, "--error");
  }
  expect_refused("render one.obj -o out.png --error 0.1 --runs 2", 2, "--runs");
}

// Edges and shadows of a lamp, on plain ground: most pixels need few samples.
TEST_F(Command, AdaptiveSamplesReachAnErrorWithFewerRays) {
  write("contrast.json", R"({"meshes": {"ground": {"file": "ground.obj"}, "fence": {"file": "fence.obj"}},
 "objects": [{"mesh": "ground"}, {"mesh": "fence"}],
 "camera": {"position": [0, 3, 6], "target": [0, 0.5, 0]},
 "lights": [{"position": [1, 4, -2], "radiance": [12, 12, 12], "shadows": true}]})");
  write("ground.obj", "v -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nf 1 2 3 4\n");
  std::string fence;
  for (int i = 0; i < 9; ++i) {
    const std::string x = std::to_string(-2 + 0.5 * i), right = std::to_string(-1.8 + 0.5 * i);
    fence +=
        "v " + x + " 0 0\nv " + right + " 0 0\nv " + right + " 1.5 0\nv " + x + " 1.5 0\nf -4 -3 -2 -1\n";
  }
  write("fence.obj", fence);
  struct Reached {
    ReadExr radiance;
    double rays, error;
  };
  const auto reach = [](const std::string& options) {
    const Outcome outcome = run("render contrast.json --size 96x72 -o a.exr --json - " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    return Reached{read_exr("a.exr"), report["rays"]["primary"], report["refined"]["error"]};
  };
  const Reached uniform = reach("--error 0.01"), adaptive = reach("--error 0.01 --adaptive"),
                limit = reach("--error 1e-9 --spp 1024");
  const auto error_of = [&](const Reached& reached) {
    double sum = 0;
    for (std::size_t i = 0; i < limit.radiance.rgb.size(); ++i) {
      const glm::vec3 weights(0.2126f, 0.7152f, 0.0722f);
      const double is = glm::dot(reached.radiance.rgb[i], weights),
                   should = glm::dot(limit.radiance.rgb[i], weights);
      sum += (is - should) * (is - should) / (should * should + 1e-4);
    }
    return std::sqrt(sum / static_cast<double>(limit.radiance.rgb.size()));
  };
  EXPECT_LE(uniform.error, 0.01);
  EXPECT_LE(adaptive.error, 0.01);
  EXPECT_LT(error_of(adaptive), 0.0125);
  EXPECT_LT(adaptive.rays, uniform.rays / 3);
  RecordProperty("rays",
                 std::to_string(uniform.rays) + " uniform, " + std::to_string(adaptive.rays) + " adaptive");
  RecordProperty("errors",
                 std::to_string(error_of(uniform)) + " uniform, " + std::to_string(error_of(adaptive)));
  expect_refused("render one.obj -o out.png --seconds 1 --adaptive", 2, "--adaptive");
  expect_refused("render one.obj -o out.png --adaptive", 2, "--adaptive");
}

TEST_F(Command, AnExrIsOfColours) {
  expect_refused("render one.obj -o out.exr --show depth", 2, "PNG");
  expect_refused("render one.obj -o out.hdr", 2, ".png or .exr");
  EXPECT_FALSE(fs::exists("out.exr"));
  expect_refused("render one.obj --size 8x8 -o none/out.exr", 1, "none/out.exr");
}

}  // namespace
}  // namespace coppice
