// The command line as others' scripts call it: exit status, one clear line for bad input, nothing
// half-written, JSON.
#include <glm/vec3.hpp>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/command.h"

namespace coppice {
namespace {

TEST_F(Command, BadScenesAreRefusedWithStatus1) {
  write("empty.obj", "");
  write("binary.obj", std::string("\x7f"
                                  "ELF\0\0\0",
                                  7));
  write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  fs::create_directory("folder.obj");
  const struct {
    const char *scene, *part;
  } cases[] = {{"missing.obj", "missing.obj"}, {"folder.obj", "folder.obj"},  {"empty.obj", "empty.obj"},
               {"binary.obj", "binary.obj"},   {"index.obj", "index.obj:4"},  {"nonsense", "nonsense"},
               {"scatter:0", "scatter:0"},     {"hard:nonsense", "nonsense"}, {"hard:nested:5:x", "'x'"}};
  for (const auto& c : cases) expect_refused(std::string("render ") + c.scene + " -o out.png", 1, c.part);
}

TEST_F(Command, AFaceOfTwoCornersIsLeftOutAndNamed) {
  write("short.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\n");
  const Outcome outcome = run("render short.obj --size 64x48 -o out.png");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("short.obj:4"), std::string::npos) << outcome.err;
}

TEST_F(Command, BadFlagsAreRefusedWithStatus2) {
  const struct {
    const char *arguments, *part;
  } cases[] = {{"render one.obj -o out.png --builder nonsense", "nonsense"},
               {"render one.obj -o out.png --nonsense", "nonsense"},
               {"render one.obj -o out.png --radius 0", "--radius"},
               {"render one.obj -o out.png --radius 101", "--radius"},
               {"render one.obj -o out.png --morton-bits 31", "--morton-bits"},
               {"render one.obj -o out.png --variants sort=nonsense", "sort has no variant 'nonsense'"},
               {"render one.obj -o out.png --size 0x0", "--size"},
               {"render one.obj -o out.png --size 100000x100000", "--size"},
               {"render one.obj -o out.png --size 64", "--size"},
               {"render one.obj -o out.png --spp 0", "--spp"},
               {"render one.obj -o out.png --camera 1,2", "--camera"},
               {"render one.obj -o out.png --camera ''", "--camera"},
               {"render one.obj -o out.png --camera 1,2,3,0,0,x", "'x' is no number"},
               {"render one.obj -o out.png --camera 1,2,3,0,0,inf", "--camera: all numbers"},
               {"render one.obj -o out.png --camera 1,2,3,1,2,3", "--camera: eye and target"},
               {"render one.obj -o out.png --camera 1,2,3,0,0,0,181", "--camera: the field of view"},
               {"render one.obj -o out.png --camera 0,5,0,0,0,0,40,0,1,0", "--camera: up is along"},
               {"render one.obj -o out.png --up w", "--up"},
               {"build one.obj --up z", "--up"},
               {"render one.obj two.obj -o out.png", "two.obj"},
               {"build one.obj --runs 0", "--runs"},
               {"nonsense", "nonsense"},
               {"", "command"}};
  for (const auto& c : cases) expect_refused(c.arguments, 2, c.part);
}

// A house of 8 m, in y up and z up, here and in map coordinates, by itself and by a camera in those.
TEST_F(Command, AHouseLooksTheSameWhereverItStands) {
  const auto house = [](glm::dvec3 at, bool z_up) {
    std::ostringstream text;
    text << std::setprecision(17);
    for (const glm::dvec3 p : {glm::dvec3{0, 0, 0},
                               {8, 0, 0},
                               {8, 3, 0},
                               {0, 3, 0},
                               {4, 5.25, 0},
                               {4, 5.25, 6},
                               {0, 0, 6},
                               {8, 0, 6},
                               {8, 3, 6},
                               {0, 3, 6}}) {
      const glm::dvec3 turned = z_up ? glm::dvec3{p.x, -p.z, p.y} : p;
      text << "v " << turned.x + at.x << ' ' << turned.y + at.y << ' ' << turned.z + at.z << '\n';
    }
    text << "f 1 2 3 5 4\nf 7 8 9 6 10\nf 1 4 10 7\nf 2 8 9 3\nf 4 5 6 10\nf 5 3 9 6\n";
    return text.str();
  };
  write("here.obj", house({0, 0, 0}, false));
  write("here_z.obj", house({0, 0, 0}, true));
  write("utm.obj", house({512345.25, 121.5, -5412345.75}, false));
  write("utm_z.obj", house({512345.25, 5412345.75, 121.5}, true));
  const auto render = [](const std::string& arguments) {
    const Outcome outcome =
        run("render --size 100x75 --builder lbvh --tracer cpu -o out.png --json - " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const nlohmann::json here = render("here.obj");
  EXPECT_GT(here["hits"], 1000);
  EXPECT_EQ(here["offset"], nlohmann::json({0, 0, 0}));
  EXPECT_EQ(render("here_z.obj --up z")["image_hash"], here["image_hash"]);
  const nlohmann::json utm = render("utm.obj");
  EXPECT_EQ(utm["hits"], here["hits"]);
  EXPECT_EQ(utm["offset"], nlohmann::json({512352, 128, -5412344}));
  EXPECT_EQ(utm["build"]["offset"], utm["offset"]);
  EXPECT_NEAR(utm["camera"]["eye"][2], here["camera"]["eye"][2].get<double>() - 5412345.75, 1e-5);
  EXPECT_EQ(render("utm_z.obj --up z")["hits"], here["hits"]);

  EXPECT_EQ(
      render("--camera 4,2,40,4,2.5,3,20,0.1,1,0 here.obj")["hits"],
      render("--camera 512349.25,123.5,-5412305.75,512349.25,124,-5412342.75,20,0.1,1,0 utm.obj")["hits"]);
  // From straight above, north up on the map.
  const nlohmann::json above =
      render("utm_z.obj --up z --camera 512349.25,5412342.75,160,512349.25,5412342.75,121.5");
  EXPECT_GT(above["hits"], 100);
  EXPECT_NEAR(above["camera"]["up"][1], 1, 1e-12);
}

TEST_F(Command, UnknownDeviceAndUnwritableOutputAreNamed) {
  expect_refused("render one.obj -o out.png --device 99", 1, "99");
  expect_refused("render one.obj -o out.png --device nonsense", 1, "--device: no device 'nonsense'");
  expect_refused("compare one.obj --timeout nan", 2, "--timeout");
  expect_refused("render one.obj -o nowhere/out.png", 1, "nowhere/out.png");
  expect_refused("build one.obj --json nowhere/report.json", 1, "nowhere/report.json");
}

TEST_F(Command, ARenderThatFailsLeavesAnOlderPictureAlone) {
  write("old.png", "old");
  EXPECT_EQ(run("render missing.obj -o old.png").status, 1);
  EXPECT_EQ(read("old.png"), "old");
}

TEST_F(Command, BuildersReportTheSameTree) {
  nlohmann::json reports[2];
  int i = 0;
  for (const char* builder : {"gpu-ploc", "ploc"}) {
    const Outcome outcome = run(std::string("build terrain:5000 --json - --runs 1 --builder ") + builder);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    reports[i++] = nlohmann::json::parse(outcome.out);
  }
  for (const char* key : {"scene",   "triangles", "inactive",   "builder",      "radius",       "morton_bits",
                          "device",  "driver",    "build_ms",   "build_ms_min", "build_ms_max", "runs",
                          "wall_ms", "kernels",   "dispatches", "rounds",       "rounds_bound", "nodes",
                          "leaves",  "depth",     "sah",        "references",   "tree_hash"}) {
    EXPECT_TRUE(reports[0].contains(key)) << key;
  }
  for (const char* key : {"tree_hash", "sah", "depth", "rounds", "nodes"})
    EXPECT_EQ(reports[0][key], reports[1][key]);
  EXPECT_EQ(reports[0]["nodes"], 9999);
  EXPECT_EQ(reports[0]["tree_hash"].get<std::string>().size(), 16u);
}

TEST_F(Command, BothTreesGiveTheSamePicture) {
  for (const char* builder : {"gpu-ploc", "sah"}) {
    std::vector<nlohmann::json> pictures;
    for (const std::string tree : {"binary", "wide", "wide-single"}) {
      const Outcome outcome =
          run(std::string("render terrain:5000 --size 100x75 --spp 2 --validate -o out.png "
                          "--json - --builder ") +
              builder + " --tree " + tree);
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      pictures.push_back(nlohmann::json::parse(outcome.out));
      EXPECT_EQ(pictures.back()["tree"], tree == "binary" ? "binary" : "wide");
    }
    EXPECT_EQ(pictures[0]["wide_ms"], 0);
    for (const int wide : {1, 2}) {
      EXPECT_EQ(pictures[0]["image_hash"], pictures[wide]["image_hash"]) << builder;
      EXPECT_EQ(pictures[0]["hits"], pictures[wide]["hits"]) << builder;
      EXPECT_GT(pictures[wide]["wide_ms"], 0);
    }
  }
}

TEST_F(Command, AWideTreeNeedsTheAccurateTests) {
  for (const char* flags : {"--triangle-test fast", "--box-test fast", "--builder none"}) {
    const Outcome outcome = run(std::string("render terrain:500 --size 8x8 --tree wide -o out.png ") + flags);
    EXPECT_NE(outcome.status, 0) << flags;
    EXPECT_NE(outcome.err.find("--tree wide"), std::string::npos) << outcome.err;
  }
}

TEST_F(Command, ChoosesTheMortonBitsThatTheSceneCallsFor) {
  std::string crowded;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const std::uint64_t x = i * 7919 % 3001, y = i * 104729 % 2999, z = i * 1299709 % 2971;
    for (const int side : {0, 1, 2}) {
      crowded += "v " + std::to_string(x + side % 2) + " " + std::to_string(y + side / 2) + " " +
                 std::to_string(z) + "\n";
    }
    crowded += "f -3 -2 -1\n";
  }
  write("crowded.obj", crowded + "v 9999999 9999999 0\nf -1 -1 -1\n");
  const auto report_of = [](const std::string& arguments) {
    const Outcome outcome = run("build --runs 1 --json - " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const bool noted = outcome.err.find("Morton codes of 60 bits") != std::string::npos;
    return std::pair(nlohmann::json::parse(outcome.out), noted);
  };
  const auto [on_device, noted] = report_of("crowded.obj");
  EXPECT_EQ(on_device["morton_bits"], 60);
  EXPECT_TRUE(noted);
  const auto [on_host, noted_too] = report_of("crowded.obj --builder ploc");
  EXPECT_EQ(on_host["morton_bits"], 60);
  EXPECT_TRUE(noted_too);
  EXPECT_EQ(on_host["tree_hash"], on_device["tree_hash"]);
  const auto [with_30, noted_30] = report_of("crowded.obj --morton-bits 30");
  EXPECT_EQ(with_30["morton_bits"], 30);
  EXPECT_FALSE(noted_30);
  EXPECT_NE(with_30["tree_hash"], on_device["tree_hash"]);
  EXPECT_EQ(report_of("terrain:5000").first["morton_bits"], 30);
  EXPECT_EQ(report_of("terrain:5000 --morton-bits 60").first["morton_bits"], 60);
  expect_refused("build --morton-bits 45", 2, "45");
}

TEST_F(Command, RendersOfAllBuildersAndTracersAgree) {
  std::vector<std::string> hashes;
  std::uint64_t hits = 0;
  for (const char* how : {"--builder gpu-ploc", "--builder ploc", "--builder none"}) {
    const Outcome outcome =
        run(std::string("render terrain:500 --size 64x48 -o out.png --validate --json - ") + how);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["rays"]["primary"], 64 * 48);
    EXPECT_EQ(report["effects"], nlohmann::json({"ambient", "directional_light"}));
    EXPECT_GT(fs::file_size("out.png"), 100u);
    hashes.push_back(report["image_hash"]);
    hits = report["hits"];
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
  const Outcome cpu = run("render terrain:500 --size 64x48 -o out.png --tracer cpu --builder ploc --json -");
  ASSERT_EQ(cpu.status, 0) << cpu.err;
  EXPECT_NEAR(nlohmann::json::parse(cpu.out)["hits"].get<double>(), static_cast<double>(hits), 3);
}

TEST_F(Command, LockstepFindsNoDifference) {
  const Outcome outcome = run("lockstep hard:nested:500 --size 32x24 --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(report["equal"]);
  EXPECT_TRUE(report["first_difference"].is_null());
  EXPECT_GE(report["stages"], 10);
}

TEST_F(Command, InactiveAndMissingTrianglesStillGiveAPicture) {
  write("none.obj", "v 0 0 0\n");
  for (const char* scene :
       {"none.obj", "one.obj", "hard:all-non-finite", "hard:non-finite", "hard:huge", "hard:tiny"}) {
    for (const char* how : {"", " --builder ploc --tracer cpu", " --builder none"}) {
      const Outcome outcome = run(std::string("render ") + scene + " --size 32x24 -o out.png" + how);
      EXPECT_EQ(outcome.status, 0) << scene << how << ": " << outcome.err;
      EXPECT_TRUE(fs::exists("out.png"));
      fs::remove("out.png");
    }
  }
}

TEST_F(Command, ComparesBuildersOnAScene) {
  const Outcome outcome =
      run("compare terrain:200 --builders ploc,gpu-ploc,none --size 32x24 --plot plot.svg --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = nlohmann::json::parse(outcome.out)[0]["builders"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["tree_hash"], rows[1]["tree_hash"]);
  EXPECT_EQ(rows[2]["steps_per_ray"], 200);
  EXPECT_NE(read("plot.svg").find("gpu-ploc"), std::string::npos);
}

TEST_F(Command, ARowOverItsTimeIsInfeasible) {
  const Outcome outcome = run("compare scatter:6000000 --builders lbvh --timeout 0.1 --markdown table.md");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("no builder gave a result"), std::string::npos) << outcome.err;
  EXPECT_NE(read("table.md").find("| lbvh | X (over 0.1 s) |"), std::string::npos) << read("table.md");
}

TEST_F(Command, TraceEventsNameTheKernels) {
  ASSERT_EQ(run("build terrain:5000 --runs 1 --trace-events events.json").status, 0);
  const auto events = nlohmann::json::parse(read("events.json"))["traceEvents"];
  const auto named = [&](const char* name) {
    return std::ranges::any_of(
        events, [&](const auto& event) { return event["name"] == name && event["ph"] == "X"; });
  };
  for (const char* name : {"primitive_bounds", "morton_codes", "ploc_merge", "ploc_finish"})
    EXPECT_TRUE(named(name)) << name;
}

TEST_F(Command, ListsScenesAndDevices) {
  const auto scenes = nlohmann::json::parse(run("scenes --json -").out);
  EXPECT_EQ(scenes[0]["name"], "grove");
  EXPECT_NE(run("scenes").out.find("scenes --hard"), std::string::npos);
  const auto hard_scenes = nlohmann::json::parse(run("scenes --hard --json -").out);
  EXPECT_EQ(hard_scenes[0]["name"], "hard:coincident");
  const std::string hard_lines = run("scenes --hard").out;
  for (const auto& scene : hard_scenes) {
    EXPECT_NE(hard_lines.find(scene["name"].get<std::string>() + " "), std::string::npos) << scene["name"];
  }
  const auto devices = nlohmann::json::parse(run("devices --json -").out);
  EXPECT_FALSE(devices.empty());
}

// One level or two: the same picture.
TEST_F(Command, InstancesAreRenderedByEveryTracer) {
  std::set<std::string> hashes;
  for (const char* how : {"", "--tree wide", "--builder gpu-hploc", "--builder sah", "--tracer cpu"}) {
    const Outcome outcome =
        run("render instances:30 --size 64x48 -o out.png --json out.json " + std::string(how));
    ASSERT_EQ(outcome.status, 0) << how << outcome.err;
    const auto report = nlohmann::json::parse(read("out.json"));
    const bool two_levels = std::string_view(how).empty() || std::string_view(how).ends_with("hploc");
    EXPECT_EQ(report.value("instances", 0), two_levels ? 30 : 0) << how;
    EXPECT_GT(report["hits"], 100) << how;
    hashes.insert(report["image_hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 1u);
  fs::remove("out.png");
  expect_refused("render instances:0 -o out.png", 1, "instances");
  const Outcome too_many = run_in(4'000'000, "render instances:67107840 -o out.png");
  EXPECT_EQ(too_many.status, 1);
  EXPECT_NE(too_many.err.find("bytes of memory"), std::string::npos) << too_many.err;
}

}  // namespace
}  // namespace coppice
