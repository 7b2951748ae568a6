// `coppice animate` as scripts and a farm's scheduler call it.
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/command.h"

namespace coppice {
namespace {

using nlohmann::json;

constexpr const char* small_scene = "animate moving:600 --size 48x32 ";

json json_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out, nullptr, false);
}

using CommandAnimate = Command;

TEST_F(CommandAnimate, SaysWhatEveryFrameTook) {
  const json report = json_of(run(std::string(small_scene) + "--frames 5 --validate --json -"));
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["frames"], 5);
  EXPECT_EQ(report["update"], "rebuild");
  EXPECT_EQ(report["rebuilds"], 5);
  EXPECT_EQ(report["refits"], 0);
  EXPECT_EQ(report["host_waits_per_frame"], 1.0);
  EXPECT_GT(report["peak_device_bytes"], 0);
  for (const char* const part : {"frame_ms", "build_ms", "trace_ms", "wide_ms", "vertices_ms", "device_ms"}) {
    for (const char* const percentile : {"p50", "p95", "p99", "max"})
      EXPECT_TRUE(report[part][percentile].is_number()) << part << ' ' << percentile;
    EXPECT_LE(report[part]["p50"], report[part]["p95"]) << part;
    EXPECT_LE(report[part]["p99"], report[part]["max"]) << part;
  }
  const std::set<std::string> hashes(report["frame_hashes"].begin(), report["frame_hashes"].end());
  EXPECT_EQ(report["frame_hashes"].size(), 5u);
  EXPECT_EQ(hashes.size(), 5u) << "the scene moves";
  std::set<std::string> kernels;
  for (const json& kernel : report["kernels"]) kernels.insert(kernel["name"]);
  for (const char* const stage : {"vertex_deform", "vertex_pose", "gather_triangles", "hploc_build"})
    EXPECT_TRUE(kernels.contains(stage)) << stage;
}

// Which dispatches have work differs from frame to frame: those of one frame must not be taken for another's.
TEST_F(CommandAnimate, KernelsAreThoseOfTheLastFrame) {
  write("explode.json", R"({ "duration": 1, "meshes": { "ball": { "built_in": "hard:sphere:600" } },
      "objects": [ { "mesh": "ball", "deform": { "kind": "explode", "amount": 1, "seconds": 1 } } ] })");
  const auto bytes_of = [&](const std::string& frames) {
    json bytes;
    const std::string arguments =
        "animate explode.json --size 48x32 --builder gpu-ploc --tree wide --radius 1 ";
    for (const json& kernel : json_of(run(arguments + "--json - --frames " + frames))["kernels"])
      bytes[std::string(kernel["name"])] = {kernel["dispatches"], kernel["bytes"]};
    return bytes;
  };
  EXPECT_EQ(bytes_of("3"), bytes_of("2..2"));
  EXPECT_EQ(bytes_of("10"), bytes_of("9..9"));
}

// The tree that makes the first frame in the least time, whichever that is; the picture is that of any.
TEST_F(CommandAnimate, TriesTreesFirst) {
  const std::string frames = std::string(small_scene) + "--json - --frames ";
  const json report = json_of(run(frames + "30"));
  ASSERT_EQ(report["tried"].size(), 4u);
  json least = report["tried"][0];
  for (const json& tree : report["tried"])
    if (tree["frame_ms"] < least["frame_ms"]) least = tree;
  EXPECT_EQ(report["builder"], least["builder"]);
  EXPECT_EQ(report["tree"], least["tree"] == "binary" ? "binary" : "wide");
  const json other = json_of(run(frames + "30 --builder gpu-lbvh --tree wide-single"));
  EXPECT_FALSE(other.contains("tried"));
  EXPECT_EQ(other["frame_hashes"], report["frame_hashes"]);
  EXPECT_FALSE(json_of(run(frames + "29")).contains("tried"));
}

// A few at a time, as a farm does it, the frames are those of one run; and what is there already stays.
TEST_F(CommandAnimate, TwoProcessesShareASequence) {
  const std::string program = std::string("timeout 100 ") + COPPICE_PROGRAM + " " + small_scene;
  const std::string both = "(" + program + "--frames 0..3 -o shared --json a.json & one=$!; " + program +
                           "--frames 4..6 -o shared --json b.json; two=$?; wait $one && exit $two)";
  ASSERT_EQ(std::system(("exec 2>err.txt; " + both).c_str()), 0) << read("err.txt");
  const json whole = json_of(run(std::string(small_scene) + "--frames 7 -o alone --json -"));
  json hashes = json::parse(read("a.json"))["frame_hashes"];
  const json second = json::parse(read("b.json"));
  for (const json& hash : second["frame_hashes"]) hashes.push_back(hash);
  EXPECT_EQ(whole["frame_hashes"], hashes);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator("shared")) {
    ++files;
    EXPECT_EQ(read(entry.path()), read(fs::path("alone") / entry.path().filename())) << entry.path();
  }
  EXPECT_EQ(files, 7u);

  fs::remove("shared/frame_00002.png");
  write("shared/frame_00005.png", "as it was");
  const json rest =
      json_of(run(std::string(small_scene) + "--frames 0..6 -o shared --skip-existing --json -"));
  EXPECT_EQ(rest["skipped"], 6);
  EXPECT_EQ(rest["frame_numbers"], json::array({2}));
  EXPECT_EQ(read("shared/frame_00002.png"), read("alone/frame_00002.png"));
  EXPECT_EQ(read("shared/frame_00005.png"), "as it was");
}

// By a program of that name, which here writes down what it is told.
TEST_F(CommandAnimate, LetsFfmpegMakeAFilmOrSaysWhatItSaid) {
  const auto run_by = [](const std::string& script, const std::string& arguments) {
    fs::create_directory("bin");
    write("bin/ffmpeg", "#!/bin/sh\n" + script + "\n");
    fs::permissions("bin/ffmpeg", fs::perms::owner_all);
    return run_with("export PATH=\"$PWD/bin:$PATH\"; ", std::string(small_scene) + arguments);
  };
  const std::string tell = "for last; do :; done; echo \"$@\" > \"$last\"";
  const Outcome made = run_by(tell, "--frames 3..4 --fps 12 -o 50%of --video film.mp4");
  ASSERT_EQ(made.status, 0) << made.err;
  const std::string told = read("film.mp4");
  for (const char* const part :
       {"-framerate 12 ", "-start_number 3 ", "-i 50%%of/frame_%05d.png ", "-frames:v 2 "})
    EXPECT_NE(told.find(part), std::string::npos) << told;
  EXPECT_TRUE(fs::exists("50%of/frame_00004.png"));

  const Outcome failed =
      run_by("echo no such codec >&2; exit 3", "--frames 2 -o shots --video film.webp --json frames.json");
  EXPECT_EQ(failed.status, 1);
  EXPECT_NE(failed.err.find("film.webp: ffmpeg failed: no such codec"), std::string::npos) << failed.err;
  EXPECT_FALSE(fs::exists("film.webp") || fs::exists(".part-film.webp"));
  EXPECT_TRUE(fs::exists("shots/frame_00001.png"));
  EXPECT_EQ(json::parse(read("frames.json"))["frames"], 2) << "what was measured is not lost";
}

TEST_F(CommandAnimate, WritesCurvesAndATable) {
  const Outcome outcome =
      run(std::string(small_scene) + "--frames 2..4 --fps 10 --plot curves.svg --csv frames.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("frames a second"), std::string::npos) << outcome.out;
  const std::string csv = read("frames.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4) << csv;
  EXPECT_NE(csv.find("\n2,"), std::string::npos) << csv;
  const std::string svg = read("curves.svg");
  EXPECT_EQ(svg.rfind("</svg>\n"), svg.size() - 7);
  EXPECT_NE(svg.find("trace"), std::string::npos);
}

TEST_F(CommandAnimate, AScenePicturedStandsStillAndSaysSo) {
  const Outcome outcome = run("animate one.obj --size 32x24 --frames 3 --json -");
  const json report = json_of(outcome);
  EXPECT_NE(outcome.err.find("nothing moves"), std::string::npos) << outcome.err;
  EXPECT_EQ(report["frame_hashes"][0], report["frame_hashes"][2]);
  const json still = json_of(run("render one.obj --size 32x24 -o out.png --json -"));
  EXPECT_EQ(report["frame_hashes"][0], still["image_hash"]);
}

// Two levels: the first frame is that of `render`, and without them nothing moves.
TEST_F(CommandAnimate, MovesInstances) {
  const std::string swarm = "instances:200 --size 48x32 ";
  const json report = json_of(run("animate " + swarm + "--frames 4 --fps 2 --validate --csv f.csv --json -"));
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["instances"], 200);
  EXPECT_EQ(report["tree"], "binary");
  EXPECT_EQ(report["rebuilds"], 4);
  EXPECT_EQ(report["host_waits_per_frame"], 1.0);
  EXPECT_GT(report["sah"][3], 1.0);
  const std::set<std::string> hashes(report["frame_hashes"].begin(), report["frame_hashes"].end());
  EXPECT_EQ(hashes.size(), 4u) << "instances move";
  const json still = json_of(run("render " + swarm + "-o still.png --json -"));
  EXPECT_EQ(report["frame_hashes"][0], still["image_hash"]);
  std::set<std::string> kernels;
  for (const json& kernel : report["kernels"]) kernels.insert(kernel["name"]);
  for (const char* const stage : {"move_instances", "instance_boxes", "trace_instances", "place_hits"})
    EXPECT_TRUE(kernels.contains(stage)) << stage;

  const Outcome flat = run("animate " + swarm + "--frames 2 --fps 2 --tree wide --json -");
  const json flattened = json_of(flat);
  EXPECT_NE(flat.err.find("--tree binary"), std::string::npos) << flat.err;
  EXPECT_FALSE(flattened.contains("instances"));
  for (const json& hash : flattened["frame_hashes"]) EXPECT_EQ(hash, still["image_hash"]);
  const json refits = json_of(run("animate " + swarm + "--frames 4 --fps 2 --update refit --json -"));
  EXPECT_EQ(refits["refits"], 3);
  EXPECT_EQ(refits["frame_hashes"], report["frame_hashes"]);
  const Outcome text = run("animate " + swarm + "--frames 1");
  EXPECT_NE(text.out.find("in 200 instances of meshes"), std::string::npos) << text.out;
}

// What is seen in place of colours, of instances.
TEST_F(CommandAnimate, RendersInstanceIds) {
  const std::string render = "render instances:60 --size 48x32 -o ids.png --json - ";
  const json ids = json_of(run(render + "--show instances"));
  EXPECT_EQ(ids["show"], "instances");
  EXPECT_EQ(ids["instances"], 60);
  const json morton = json_of(run(render + "--show morton"));
  EXPECT_EQ(morton["instances"], 60);
  EXPECT_NE(ids["image_hash"], morton["image_hash"]);
  const json clusters = json_of(run(render + "--show clusters --round 1 --builder gpu-ploc"));
  EXPECT_LT(clusters["shown"]["clusters"], 60) << "of instances";
  const json normals = json_of(run(render + "--show normals"));
  EXPECT_EQ(normals["image_hash"], json_of(run(render + "--show normals --tree wide"))["image_hash"]);
  expect_refused("render one.obj -o ids.png --show instances", 1, "has no instances");
  expect_refused("render instances:60 -o ids.png --show instances --tree wide", 2, "a binary tree");
}

// A scene file says that its objects are instances, and that they move.
TEST_F(CommandAnimate, MovesTheObjectsOfASceneFile) {
  const std::string objects =
      R"("meshes": {"m": {"built_in": "hard:sphere:200"}}, "camera": {"position": [0, 3, 40], "target": [0, 0, 0]},
         "objects": [{"mesh": "m", "translation": [5, 0, 0]}, {"mesh": "m", "scale": [-1, 2, 1]},
                     {"mesh": "m", "translation": [-4, 3, 1], "rotation": [0, 0, 1, 1]}])";
  write("flat.json", "{" + objects + "}");
  write("swarm.json",
        "{" + objects + R"(, "instances": {"swarm": {"seconds": 10}}, "frames_per_second": 1})");
  const json flat = json_of(run("render flat.json --size 48x32 -o flat.png --json -"));
  const json still = json_of(run("render swarm.json --size 48x32 -o swarm.png --json -"));
  EXPECT_EQ(still["instances"], 3);
  EXPECT_GT(still["hits"], 50);
  EXPECT_EQ(still["image_hash"], flat["image_hash"]);
  const json report = json_of(run("animate swarm.json --size 48x32 --frames 3 --json -"));
  EXPECT_EQ(report["instances"], 3);
  EXPECT_EQ(report["frames_per_second"], 1.0);
  EXPECT_EQ(report["frame_hashes"][0], still["image_hash"]);
  EXPECT_NE(report["frame_hashes"][1], report["frame_hashes"][2]);
}

// Objects that keyframes move and meshes that deform stay instances; as triangles of one level they move,
// too.
TEST_F(CommandAnimate, MovesAndDeformsInstances) {
  write("herd.json", R"({"meshes": {"m": {"built_in": "hard:sphere:200"}, "g": {"built_in": "terrain:200"}},
    "camera": {"position": [0, 3, 40], "target": [0, 0, 0]}, "frames_per_second": 2,
    "objects": [{"mesh": "m", "keyframes": {"translation": {"times": [0, 4], "values": [[5, 0, 0], [-5, 2, 0]]}}},
                {"mesh": "m", "scale": [-1, 2, 1]},
                {"mesh": "m", "translation": [-4, 3, 1], "deform": {"kind": "twist"}},
                {"mesh": "g", "translation": [0, -8, 0], "deform": {"kind": "wave"}}], "instances": {}})");
  const std::string herd = "herd.json --size 48x32 ", frames = "--frames 3 --json - ";
  const json report = json_of(run("animate " + herd + frames + "--validate --kernels"));
  EXPECT_EQ(report["instances"], 4);
  EXPECT_EQ(report["tree"], "binary");
  EXPECT_EQ(report["rebuilds"], 3);
  const json hashes = report["frame_hashes"];
  EXPECT_NE(hashes[1], hashes[2]);
  std::map<std::string, json> kernels;
  for (const json& kernel : report["kernels"]) kernels[kernel["name"]] = kernel;
  EXPECT_EQ(kernels["hploc_build"]["dispatches"], 3) << "two meshes and the instances";
  EXPECT_TRUE(kernels.contains("vertex_deform") && kernels.contains("trace_instances"));
  const json refits = json_of(run("animate " + herd + frames + "--update refit"));
  EXPECT_EQ(refits["refits"], 2);
  EXPECT_EQ(refits["frame_hashes"], hashes);
  const Outcome flat = run("animate " + herd + frames + "--tree wide");
  const json flattened = json_of(flat);
  EXPECT_EQ(flat.err.find("nothing moves"), std::string::npos) << flat.err;
  EXPECT_FALSE(flattened.contains("instances"));
  EXPECT_NE(flattened["frame_hashes"][1], flattened["frame_hashes"][2]);
}

TEST_F(CommandAnimate, BuildsNothingWhereOnlyTheCameraMoves) {
  write("round.json", R"({"meshes": {"m": {"built_in": "hard:sphere:200"}}, "instances": {},
    "camera": {"position": [0, 3, 40], "target": [0, 0, 0],
               "keyframes": {"position": {"times": [0, 4], "values": [[0, 3, 40], [40, 3, 0]]}}},
    "objects": [{"mesh": "m"}, {"mesh": "m", "translation": [9, 0, 0]}]})");
  const json report = json_of(run("animate round.json --size 48x32 --frames 3 --fps 1 --json - --kernels"));
  EXPECT_EQ(report["rebuilds"], 0);
  EXPECT_EQ(report["refits"], 0);
  EXPECT_NE(report["frame_hashes"][0], report["frame_hashes"][1]);
  for (const json& kernel : report["kernels"]) EXPECT_NE(kernel["name"], "hploc_build");
}

TEST_F(CommandAnimate, RefusesWhatItCannotDo) {
  write("file", "no folder");
  const struct {
    const char *arguments, *part;
    int status;
  } cases[] = {{"--frames 0", "--frames: '0'", 2},
               {"--frames 5..4", "--frames: '5..4'", 2},
               {"--frames 1..", "--frames: '1..'", 2},
               {"--frames -3", "--frames", 2},
               {"--frames 2000000", "--frames", 2},
               {"--fps 0", "--fps", 2},
               {"--fps nan", "--fps", 2},
               {"--video a.mp4", "--video needs", 2},
               {"--skip-existing", "--skip-existing needs", 2},
               {"-o shared --video a.avi", "does not end in .mp4 or .webp", 2},
               {"--builder sah", "--builder", 2},
               {"-o file", "file", 1},
               {"-o file/in", "file/in", 1}};
  for (const auto& c : cases) expect_refused(std::string(small_scene) + c.arguments, c.status, c.part);
  EXPECT_EQ(read("file"), "no folder");
}

}  // namespace
}  // namespace coppice
