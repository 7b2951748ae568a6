// The commands and environments: of the scene file, of the command line, missing, broken and refused.
#include <nlohmann/json.hpp>

#include "support/command.h"

namespace coppice {
namespace {

using nlohmann::json;

// A triangle over a larger one.
class CommandEnvironment : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("two.obj", "v -9 0 9\nv 9 0 9\nv 0 0 -18\nv -1 1 1\nv 1 1 1\nv 0 1 -2\nf 1 2 3\nf 4 5 6\n");
  }

  static json report_of(const std::string& arguments) {
    const Outcome outcome = run(arguments + " --size 64x48 --json -");
    EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
    return outcome.status == 0 ? json::parse(outcome.out) : json();
  }
};

TEST_F(CommandEnvironment, AnEnvironmentComesFromTheSceneOrTheCommandLine) {
  write("sky.json", R"({
    "meshes": { "two": { "file": "two.obj" } }, "objects": [ { "mesh": "two" } ],
    "camera": { "position": [3, 8, 6], "target": [0, 0, 0] }, "environment": { "sky": {} } })");
  write("two_views.json", R"({
    "meshes": { "two": { "file": "two.obj" } }, "objects": [ { "mesh": "two" } ],
    "camera": { "position": [3, 8, 6], "target": [0, 0, 0] } })");
  const json lit = report_of("render sky.json -o out.png");
  EXPECT_EQ(lit["effects"], (json{"shadows", "environment"}));
  EXPECT_GT(lit["rays"]["shadow"], 500);
  EXPECT_EQ(report_of("render two_views.json --environment sky -o out.png")["image_hash"], lit["image_hash"]);
  EXPECT_EQ(report_of("render sky.json --tracer cpu --builder ploc -o out.png")["rays"]["shadow"],
            lit["rays"]["shadow"]);
  EXPECT_EQ(report_of("animate sky.json --frames 1")["frame_hashes"][0], lit["image_hash"]);
  EXPECT_TRUE(report_of("lockstep sky.json")["equal"]);
  const json off = report_of("render sky.json --effects=-environment -o out.png");
  EXPECT_EQ(off["image_hash"], report_of("render two_views.json -o out.png")["image_hash"]);
  EXPECT_EQ(off["rays"]["shadow"], 0);
  const json costs = report_of("effects sky.json")["effects"];
  EXPECT_EQ(costs[10]["name"], "environment");
  EXPECT_GT(costs[10]["bytes"], 512 * 513 * 16);
  EXPECT_EQ(costs[10]["rays"], lit["rays"]["shadow"]);
}

TEST_F(CommandEnvironment, AnEnvironmentThatIsBrokenIsSaidAndOneThatIsMissingRefusedOrReplaced) {
  write("broken.hdr", "#?RADIANCE");
  const Outcome broken = run("render two.obj -o out.png --size 8x8 --environment broken.hdr");
  EXPECT_EQ(broken.status, 0);
  EXPECT_NE(broken.err.find("warning: broken.hdr: no Radiance HDR that can be read"), std::string::npos)
      << broken.err;
  fs::remove("out.png");
  expect_refused("render two.obj -o out.png --environment gone.hdr", 1,
                 "--environment: 'gone.hdr' is no file, expected an HDR image (.hdr, .exr) or sky");
  write("bad.json", R"({ "objects": [], "environment": { "sky": {}, "image": "a.hdr" } })");
  expect_refused("render bad.json -o out.png", 1,
                 "bad.json: /environment: expected an \"image\" or a \"sky\", one of both");
  write("gone.json", R"({
    "meshes": { "two": { "file": "two.obj" } }, "objects": [ { "mesh": "two" } ],
    "environment": { "image": "gone.hdr" } })");
  const Outcome gone = run("render gone.json -o out.png --size 8x8");
  EXPECT_EQ(gone.status, 0);
  EXPECT_NE(gone.err.find("gone.hdr: no such file, a checker takes its place as /environment"),
            std::string::npos)
      << gone.err;
}

}  // namespace
}  // namespace coppice
