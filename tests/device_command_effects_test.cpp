// The commands and their effects: what is called for, explained, overridden, counted, and refused.
#include <nlohmann/json.hpp>

#include "support/command.h"

namespace coppice {
namespace {

using nlohmann::json;

// A triangle over a larger one, and lights.
class CommandEffects : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("two.obj", "v -9 0 9\nv 9 0 9\nv 0 0 -18\nv -1 1 1\nv 1 1 1\nv 0 1 -2\nf 1 2 3\nf 4 5 6\n");
    write("scene.json", R"({
      "meshes": { "two": { "file": "two.obj" } },
      "objects": [ { "mesh": "two" } ],
      "camera": { "position": [3, 8, 6], "target": [0, 0, 0] },
      "lights": [ { "direction": [1, 2, 0], "shadows": true },
                  { "position": [0, 3, 1], "shadows": true }, { "position": [2, 2, 2] } ] })");
  }

  // A triangle with a texture that is not there.
  static void write_wall() {
    write("wall.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd gone.png\n");
    write("wall.obj",
          "mtllib wall.mtl\nusemtl wall\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
          "f 1/1 2/2 3/3\n");
  }

  static json report_of(const std::string& arguments) {
    const Outcome outcome = run(arguments + " --size 64x48 --json -");
    EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
    return outcome.status == 0 ? json::parse(outcome.out) : json();
  }
};

TEST_F(CommandEffects, RenderCountsShadowRaysAndNamesTheEffects) {
  const json with = report_of("render scene.json -o out.png --validate");
  EXPECT_EQ(with["effects"], json({"ambient", "directional_light", "lights", "shadows"}));
  EXPECT_EQ(with["rays"]["primary"], 64 * 48);
  EXPECT_GT(with["rays"]["shadow"], 64 * 48 / 2);
  const json without = report_of("render scene.json -o out.png --effects=-shadows");
  EXPECT_EQ(without["effects"], json({"ambient", "directional_light", "lights"}));
  EXPECT_EQ(without["rays"]["shadow"], 0);
  EXPECT_NE(with["image_hash"], without["image_hash"]);
  const json plain = report_of("render scene.json -o out.png --effects=-shadows,-lights");
  EXPECT_EQ(plain["effects"], json({"ambient", "directional_light"}));
  std::vector<std::string> kernels;
  for (const json& kernel : plain["kernels"]) kernels.push_back(kernel["name"]);
  if (!kernels.empty()) {  // a device without timestamps has none
    EXPECT_EQ(std::ranges::count(kernels, "shade_pixels") + std::ranges::count(kernels, "trace_pixels"), 1);
    EXPECT_EQ(std::ranges::count(kernels, "shade"), 0);
    EXPECT_EQ(std::ranges::count(kernels, "shade_lights"), 0);
  }
}

TEST_F(CommandEffects, BothTracersAndAllTreesSeeTheSameShadows) {
  const json device = report_of("render scene.json -o out.png --spp 2");
  for (const char* how : {"--tree binary", "--tree wide-single", "--builder sah", "--builder gpu-hploc"}) {
    const json other = report_of("render scene.json -o out.png --spp 2 " + std::string(how));
    EXPECT_EQ(other["image_hash"], device["image_hash"]) << how;
    EXPECT_EQ(other["rays"], device["rays"]) << how;
  }
  // The CPU tracer computes in double: a ray at the border of a shadow may go either way.
  for (const char* how : {"--builder ploc", "--builder none"}) {
    const json cpu = report_of("render scene.json -o out.png --spp 2 --tracer cpu " + std::string(how));
    EXPECT_NEAR(cpu["rays"]["shadow"].get<double>(), device["rays"]["shadow"].get<double>(), 4) << how;
    EXPECT_EQ(cpu["effects"], device["effects"]);
  }
}

TEST_F(CommandEffects, ExplainNamesWhatCalledForEach) {
  const Outcome outcome = run("render scene.json -o out.png --size 16x16 --explain --effects=-lights");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(
                "lights              off  turned off by --effects; called for by /lights/1, a point\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("shadows             on   called for by /lights/0, which casts shadows\n"),
            std::string::npos);
  const Outcome plain = run("render one.obj -o out.png --size 16x16 --explain");
  EXPECT_NE(plain.out.find("shadows             off  nothing calls for it\n"), std::string::npos)
      << plain.out;
  const json explained = report_of("render scene.json -o out.png --explain")["explained"];
  EXPECT_EQ(explained[1]["name"], "shadows");
  EXPECT_EQ(explained[1]["on"], true);
  EXPECT_EQ(explained[1]["called_by"], "/lights/0, which casts shadows");
}

TEST_F(CommandEffects, TheTableHasTheCostOfWhatIsOnAndZeroesForTheRest) {
  const json rich = report_of("effects scene.json")["effects"];
  ASSERT_EQ(rich.size(), 12u);
  EXPECT_EQ(rich[0]["name"], "lights");
  EXPECT_GT(rich[0]["rays"], 0) << "one of the points casts shadows";
  const json& shadows = rich[1];
  EXPECT_EQ(shadows["on"], true);
  EXPECT_GT(shadows["rays"], rich[0]["rays"]);
  EXPECT_GT(shadows["bytes"], 64 * 48 * 44);
  const std::vector<std::string> kernels = shadows["kernels"];
  for (const char* kernel : {"shadow_marks", "scan_tile_sums", "prefix_scan", "shadow_rays", "shade_lights"})
    EXPECT_EQ(std::ranges::count(kernels, kernel), 1) << kernel;
  EXPECT_EQ(shadows["dispatches"], 2 * 7 - 1 + 1);  // both lights' seven
  const json plain = report_of("effects one.obj")["effects"];
  for (const json& effect : plain) {
    EXPECT_EQ(effect["on"], false);
    EXPECT_EQ(effect["called_by"], nullptr);
    EXPECT_EQ(effect["kernels"], json::array());
    for (const char* zero : {"dispatches", "rays", "bytes", "ms"}) EXPECT_EQ(effect[zero], 0) << zero;
  }
  const Outcome text = run("effects scene.json --size 16x16");
  EXPECT_NE(text.out.find("shadow_marks x 2, scan_tile_sums x 2, prefix_scan x 4, "), std::string::npos)
      << text.out;
}

TEST_F(CommandEffects, ATextureThatIsMissingIsNamedAndACheckerIsSeen) {
  write_wall();
  const Outcome outcome = run("render wall.obj -o out.png --size 32x32 --explain");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("textures            on   called for by material 'wall', which has gone.png\n"),
            std::string::npos)
      << outcome.out;
  const Outcome without = run("render wall.obj -o out.png --size 32x32 --effects=-textures");
  EXPECT_EQ(without.err.find("gone.png"), std::string::npos) << without.err;
  EXPECT_NE(report_of("render wall.obj -o out.png")["image_hash"],
            report_of("render wall.obj -o out.png --effects=-textures")["image_hash"]);
  const json cost = report_of("effects wall.obj")["effects"][2];
  EXPECT_EQ(cost["name"], "textures");
  const std::vector<std::string> kernels = cost["kernels"];
  EXPECT_EQ(std::ranges::count(kernels, "texture_hits"), 1);
  EXPECT_EQ(std::ranges::count(kernels, "shade_lights"), 0);
  EXPECT_GT(cost["bytes"], 0);
}

// Whatever makes the picture, and however often its arrays are looked at.
TEST_F(CommandEffects, EveryCommandWarnsOnceOfATextureThatIsMissing) {
  write_wall();
  for (const char* command :
       {"render wall.obj -o out.png", "render wall.obj -o out.png --tracer cpu", "effects wall.obj",
        "lockstep wall.obj", "animate wall.obj --frames 2", "animate wall.obj --frames 30 --tree binary"}) {
    const Outcome outcome = run(std::string(command) + " --size 16x16");
    EXPECT_EQ(outcome.status, 0) << command << ": " << outcome.err;
    EXPECT_EQ(without_notes(outcome.err),
              "warning: gone.png: no such file, a checker takes its place as map_Kd of material 'wall'\n")
        << command;
  }
}

TEST_F(CommandEffects, TheLensIsThatOfTheSceneOrOfTheCommandLine) {
  const std::string render = "render one.obj -o out.png --camera 0,0,5,0,0,0 --spp 4";
  const json sharp = report_of(render), blurred = report_of(render + " --aperture 0.5 --focus 2");
  EXPECT_EQ(blurred["effects"].back(), "depth_of_field");
  EXPECT_NE(blurred["image_hash"], sharp["image_hash"]);
  EXPECT_EQ(blurred["image_hash"],
            report_of(render + " --aperture 0.5 --focus 2 --tree binary")["image_hash"]);
  EXPECT_EQ(report_of(render + " --aperture 0")["image_hash"], sharp["image_hash"]);
  EXPECT_EQ(report_of(render + " --aperture 0.5 --effects=-depth_of_field")["image_hash"],
            sharp["image_hash"]);
  write("lens.json", R"({ "meshes": { "two": { "file": "two.obj" } }, "objects": [ { "mesh": "two" } ],
      "camera": { "position": [3, 8, 6], "target": [0, 0, 0], "aperture": 0.5 } })");
  const json scene = report_of("render lens.json -o out.png --spp 2");
  EXPECT_EQ(report_of("animate lens.json --frames 1 --spp 2")["frame_hashes"][0], scene["image_hash"]);
  EXPECT_TRUE(report_of("lockstep lens.json --spp 2")["equal"]);
  const json cost = report_of("effects lens.json --spp 2")["effects"][3];
  EXPECT_EQ(cost["name"], "depth_of_field");
  EXPECT_EQ(cost["called_by"], "/camera/aperture");
  EXPECT_EQ(cost["kernels"], json::array());
  EXPECT_EQ(cost["rays"], 0);
  EXPECT_GT(report_of("render instances:20 -o out.png --aperture 0.5")["instances"], 0);
  const Outcome unused = run(render + " --size 16x16 --focus 2");
  EXPECT_NE(unused.err.find("warning: --focus means nothing without an aperture\n"), std::string::npos);
  fs::remove("out.png");
  expect_refused(render + " --aperture=-1", 2, "--aperture: '-1' is no length from 0 to 1e30");
  expect_refused(render + " --focus 0", 2, "--focus: '0' is no length from 1e-30 to 1e30");
}

TEST_F(CommandEffects, AmbientOcclusionIsCountedAndCosted) {
  write("nook.json", R"({ "meshes": { "two": { "file": "two.obj" } }, "objects": [ { "mesh": "two" } ],
      "camera": { "position": [3, 8, 6], "target": [0, 0, 0] }, "ambient_occlusion": { "distance": 3 } })");
  const json seen = report_of("render nook.json -o out.png --spp 2");
  EXPECT_EQ(seen["effects"].back(), "ambient_occlusion");
  EXPECT_EQ(seen["rays"]["shadow"], 0);
  EXPECT_GT(seen["rays"]["occlusion"], 64 * 48);
  const json cpu = report_of("render nook.json -o out.png --spp 2 --tracer cpu");
  EXPECT_NEAR(cpu["rays"]["occlusion"].get<double>(), seen["rays"]["occlusion"].get<double>(), 4);
  EXPECT_EQ(cpu["rays"]["shadow"], 0);
  const json frames = report_of("animate nook.json --frames 1 --spp 2");
  EXPECT_EQ(frames["frame_hashes"][0], seen["image_hash"]);
  EXPECT_EQ(frames["rays"]["occlusion"], seen["rays"]["occlusion"]);
  EXPECT_TRUE(report_of("lockstep nook.json --spp 2")["equal"]);
  const json cost = report_of("effects nook.json --spp 2")["effects"][4];
  EXPECT_EQ(cost["name"], "ambient_occlusion");
  EXPECT_EQ(cost["rays"], seen["rays"]["occlusion"]);
  EXPECT_GT(cost["bytes"], 64 * 48 * 44);
  EXPECT_EQ(report_of("render nook.json -o out.png --effects=-ambient_occlusion")["rays"]["occlusion"], 0);
  EXPECT_GT(report_of("render one.obj -o out.png --effects +ambient_occlusion")["rays"]["occlusion"], 0);
  fs::remove("out.png");
  expect_refused("render nook.json -o out.png --builder none", 1,
                 "--builder none: ambient occlusion is traced through a tree");
  expect_refused("animate instances:20 --frames 1 --size 16x16 --effects +ambient_occlusion", 1,
                 "through which no occlusion rays are traced (--effects=-ambient_occlusion goes without)");
}

TEST_F(CommandEffects, AMapOfOpacityThatIsMissingIsNamedAndHolesAreSeen) {
  write("leaf.mtl", "newmtl leaf\nKd 1 1 1\nmap_d gone.png\n");
  write("leaf.obj",
        "mtllib leaf.mtl\nusemtl leaf\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\nf 1/1 2/2 "
        "3/3\n");
  const Outcome outcome = run("render leaf.obj -o out.png --size 32x32 --explain");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("alpha               on   called for by material 'leaf', which has gone.png\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(
      outcome.err.find("gone.png: no such file, a checker takes its place as map_d of material 'leaf'\n"),
      std::string::npos)
      << outcome.err;
  const json with = report_of("render leaf.obj -o out.png --validate");
  const json without = report_of("render leaf.obj -o out.png --effects=-alpha");
  EXPECT_EQ(with["effects"], json({"ambient", "directional_light", "alpha"}));
  EXPECT_NEAR(with["hits"].get<double>(), without["hits"].get<double>() / 2, 100);
  const json cost = report_of("effects leaf.obj")["effects"][9];
  EXPECT_EQ(cost["name"], "alpha");
  const std::vector<std::string> kernels = cost["kernels"];
  EXPECT_EQ(std::ranges::count_if(kernels, [](const std::string& name) { return name.ends_with("_alpha"); }),
            1);
  EXPECT_GT(cost["bytes"], 0);
  EXPECT_TRUE(report_of("lockstep leaf.obj --effects +shadows")["equal"]);
  EXPECT_EQ(report_of("animate leaf.obj --frames 1")["frame_hashes"][0], with["image_hash"]);
  fs::remove("out.png");
  expect_refused("render leaf.obj -o out.png --builder none", 1,
                 "--builder none: alpha is looked at on the way through a tree");
  EXPECT_EQ(report_of("render leaf.obj -o out.png --builder none --effects=-alpha")["hits"], without["hits"]);
}

TEST_F(CommandEffects, AColourMapThatIsACutOutIsSeenAsOne) {
  std::string image(18, '\0');  // a TGA of a hole and a solid texel
  image[2] = 2, image[12] = 2, image[14] = 1, image[16] = 32, image[17] = 0x28;
  write("leaf.tga", image + std::string(4, '\0') + std::string(4, '\xff'));
  write("leaf.mtl", "newmtl leaf\nmap_Kd leaf.tga\n");
  write("leaf.obj",
        "mtllib leaf.mtl\nusemtl leaf\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0.25 0\nvt 0.75 0\n"
        "f 1/1 2/2 3/2 4/1\n");
  const Outcome outcome = run("render leaf.obj -o out.png --size 32x32 --explain");
  EXPECT_NE(outcome.out.find("alpha               on   called for by material 'leaf', which has leaf.tga\n"),
            std::string::npos)
      << outcome.out << outcome.err;
  const std::string straight = " --camera 0,0,4,0,0,0";  // both halves are as large
  const json with = report_of("render leaf.obj -o out.png" + straight);
  const json without = report_of("render leaf.obj -o out.png --effects=-alpha" + straight);
  EXPECT_NEAR(with["hits"].get<double>(), without["hits"].get<double>() / 2, 50);
  EXPECT_EQ(report_of("animate leaf.obj --frames 1" + straight)["frame_hashes"][0], with["image_hash"]);
  EXPECT_TRUE(report_of("lockstep leaf.obj")["equal"]);
}

TEST_F(CommandEffects, PathsAreCountedByWhatTheyMeetAndTakeATree) {
  write("mirror.mtl", "newmtl mirror\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nillum 3\nnewmtl lamp\nKe 1 1 1\n");
  write("mirror.obj",
        "mtllib mirror.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -1 0 5\nv 1 0 5\nv 0 2 5\n"
        "usemtl mirror\nf 1 2 3\nusemtl lamp\nf 4 5 6\n");
  const std::string render = "render mirror.obj -o out.png --camera 0,0,3,0,0,0";
  const json seen = report_of(render);
  EXPECT_GT(seen["rays"]["reflection"], 0);
  EXPECT_GT(seen["rays"]["shadow"], 0);
  EXPECT_EQ(seen["rays"]["refraction"], 0);
  EXPECT_EQ(seen["rays"]["diffuse"], 0);
  EXPECT_EQ(report_of(render + " --bounces 0")["rays"]["reflection"], 0);
  EXPECT_GT(report_of(render + " --effects +global_illumination")["rays"]["diffuse"], 0);
  EXPECT_EQ(report_of(render + " --tracer cpu --builder ploc")["rays"]["reflection"],
            seen["rays"]["reflection"]);
  EXPECT_TRUE(report_of("lockstep mirror.obj --camera 0,0,3,0,0,0")["equal"]);
  const json moving = report_of("animate mirror.obj --camera 0,0,3,0,0,0 --frames 2")["rays"];
  for (const char* kind : {"primary", "shadow", "reflection", "refraction", "diffuse"})
    EXPECT_EQ(moving[kind], 2 * seen["rays"][kind].get<int>()) << kind;
  fs::remove("out.png");
  expect_refused(render + " --builder none", 1,
                 "--builder none: paths of light are traced through a tree, which takes another builder "
                 "(--effects=-emission,-reflection goes without)");
  expect_refused(render + " --bounces 65", 2, "--bounces");
}

TEST_F(CommandEffects, AnimateAndLockstepTakeThem) {
  const json frames = report_of("animate scene.json --frames 2");
  EXPECT_NE(frames["frame_hashes"],
            report_of("animate scene.json --frames 2 --effects=-shadows")["frame_hashes"]);
  EXPECT_EQ(frames["rays"]["primary"], 2 * 64 * 48);
  EXPECT_GT(frames["rays"]["shadow"], 64 * 48);
  EXPECT_TRUE(report_of("lockstep scene.json")["equal"]);
  EXPECT_TRUE(report_of("lockstep one.obj --effects +shadows")["equal"]);
}

TEST_F(CommandEffects, InstancesAreFlattenedOrRefusedByOneLine) {
  const json flat = report_of("render instances:20 -o out.png --effects +shadows");
  EXPECT_GT(flat["rays"]["shadow"], 0);
  fs::remove("out.png");
  expect_refused("animate instances:20 --frames 1 --size 16x16 --effects +shadows", 1,
                 "instances that move, through which no shadow rays are traced (--effects=-shadows");
}

TEST_F(CommandEffects, WhatCannotBeIsRefusedByOneLine) {
  expect_refused("render one.obj -o out.png --effects +mist", 2,
                 "--effects: '+mist' is no + or - and an effect behind it: there are lights, shadows");
  expect_refused("render one.obj -o out.png --effects shadows", 2, "--effects: 'shadows' is no + or -");
  expect_refused("build one.obj --effects +shadows", 2, "--effects");
  expect_refused("render scene.json -o out.png --builder none", 1,
                 "--builder none: shadows are traced through a tree");
  write("bad.json", R"({ "objects": [], "lights": [ { "radiance": [1, 1, 1] } ] })");
  expect_refused("render bad.json -o out.png", 1,
                 "bad.json: /lights/0: expected a \"direction\" or a \"position\"");
}

}  // namespace
}  // namespace coppice
