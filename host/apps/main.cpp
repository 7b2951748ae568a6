#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>

#include "apps/bench.h"
#include "apps/options.h"
#include "builders/registry.h"
#include "interface/ploc.h"
#include "pipeline/build.h"
#include "scene/write_png.h"

namespace {

using coppice::Options;

constexpr std::uint32_t max_side = 16383;  // a square of it is the most that write_png takes

// "1024x768" into width and height, each 1 to max_side.
std::string parse_size(Options& options) {
  if (options.size.empty()) return {};
  const char* const end = options.size.data() + options.size.size();
  auto [middle, first_error] = std::from_chars(options.size.data(), end, options.width);
  const bool first = first_error == std::errc() && middle != end && *middle == 'x';
  const auto [last, second_error] =
      first ? std::from_chars(middle + 1, end, options.height) : std::from_chars_result{};
  const bool parsed = first && second_error == std::errc() && last == end;
  const auto in_range = [](std::uint32_t side) { return side >= 1 && side <= max_side; };
  if (parsed && in_range(options.width) && in_range(options.height)) return {};
  return "--size: '" + options.size + "' is not WxH with sides of 1 to " + std::to_string(max_side);
}

// Eye and target apart, all finite, the field of view in (0, 180).
std::string check_camera(const Options& options) {
  const std::vector<float>& camera = options.camera;
  if (camera.empty()) return {};
  const bool finite = std::ranges::all_of(camera, [](float x) { return std::isfinite(x); });
  const bool apart = !std::equal(camera.begin(), camera.begin() + 3, camera.begin() + 3);
  const bool opens = camera.size() < 7 || (camera[6] > 0 && camera[6] < 180);
  return finite && apart && opens
             ? std::string()
             : "--camera: needs finite eye and target apart, and a field of view in 0 to 180";
}

void add_common(CLI::App& command, Options& options) {
  command.add_option("--json", options.json, "write what was measured to FILE, - for stdout")
      ->type_name("FILE");
}

void add_device(CLI::App& command, Options& options) {
  command.add_option("--device", options.device, "part of a device's name, or its index")
      ->type_name("NAME|INDEX");
  command.add_flag("--validate", options.validate, "Vulkan validation layers on; a message is a failure");
}

void add_trace_events(CLI::App& command, Options& options) {
  command.add_option("--trace-events", options.trace_events, "write every kernel as a Chrome trace event")
      ->type_name("FILE");
}

void add_scene(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene, "an .obj file or a built-in scene")->capture_default_str();
}

std::vector<std::string> device_builder_names() {
  std::vector<std::string> builders;
  for (const coppice::NamedDeviceBuilder& named : coppice::device_builders())
    builders.emplace_back(named.name);
  return builders;
}

std::vector<std::string> builder_names() {
  std::vector<std::string> builders;
  for (const coppice::CpuBuilder& builder : coppice::cpu_builders()) builders.emplace_back(builder.name);
  for (std::string& name : device_builder_names()) builders.push_back(std::move(name));
  return builders;
}

void add_builder(CLI::App& command, Options& options, const std::vector<std::string>& names) {
  command.add_option("--builder", options.builder)->check(CLI::IsMember(names))->capture_default_str();
}

void add_leaf_size(CLI::App& command, Options& options) {
  command
      .add_option("--leaf-size", options.leaf_size,
                  "gd16-early: the most references that are not split any further")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
}

void add_ploc(CLI::App& command, Options& options) {
  command.add_option("--radius", options.radius, "search radius of PLOC")
      ->check(CLI::Range(1u, coppice::PLOC_MAX_RADIUS))
      ->capture_default_str();
  command
      .add_option("--morton-bits", options.morton_bits,
                  "of the codes PLOC and LBVH sort by; auto: 60 where 30 leave cells crowded")
      ->check(CLI::IsMember({"auto", "30", "60"}))
      ->capture_default_str();
  command
      .add_option("--lookback", options.lookback,
                  "prefix sums by decoupled lookback; auto: where the self-check allows it")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str();
  command
      .add_option(
          "--variants", options.variants,
          "of stages that have some; auto: as tuned, or else default, which goes by the kind of device")
      ->type_name("auto|default|STAGE=VALUE,...")
      ->check([](const std::string& text) {
        coppice::Variants variants;
        return text == "auto" || text == "default" ? std::string() : coppice::set_variants(text, variants);
      })
      ->capture_default_str();
}

void add_tree(CLI::App& command, Options& options) {
  command
      .add_option(
          "--tree", options.tree,
          "which the device's tracer walks; wide: eight children a node, rays in packets; auto: wide on CPU "
          "devices where the picture has more rays than the scene triangles")
      ->check(CLI::IsMember({"auto", "binary", "wide"}))
      ->capture_default_str();
}

void add_intersection(CLI::App& command, Options& options) {
  command
      .add_option("--triangle-test", options.triangle_test,
                  "fast: Moeller-Trumbore; watertight: Woop, Benthin and Wald")
      ->check(CLI::IsMember({"auto", "fast", "watertight"}))
      ->capture_default_str();
  command.add_option("--box-test", options.box_test, "robust: slabs widened by the rounding error")
      ->check(CLI::IsMember({"auto", "fast", "robust"}))
      ->capture_default_str();
}

void add_view(CLI::App& command, Options& options) {
  command.add_option("--size", options.size, "pixels, default 1024x768")->type_name("WxH");
  command
      .add_option("--camera", options.camera,
                  "eye, target and vertical field of view in degrees; default: frames the scene")
      ->type_name("X,Y,Z,X,Y,Z[,FOV]")
      ->delimiter(',')
      ->expected(6, 7);
}

void add_picture(CLI::App& command, Options& options) {
  add_view(command, options);
  command.add_option("--spp", options.samples, "samples per pixel")
      ->check(CLI::Range(1u, 65536u))
      ->capture_default_str();
}

void add_stability(CLI::App& command, Options& options) {
  command.add_option("--cases", options.cases, "hard cases, see 'coppice scenes --hard'; default: all")
      ->delimiter(',');
  command.add_option("--triangles", options.most_triangles, "most triangles of a case")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  command.add_option("--rays", options.rays_of_a_kind, "rays of each kind")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  command
      .add_option("--leak-rays", options.leak_rays,
                  "rays from inside of each closed mesh at each of five scales; 0: none")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40))
      ->capture_default_str();
  command.add_option("--seed", options.seed)
      ->check([](const std::string& text) {
        return text.starts_with('-') ? "'" + text + "' is no number from 0 to 2^64 - 1" : std::string();
      })
      ->capture_default_str();
  add_ploc(command, options);
  add_device(command, options);
  add_trace_events(command, options);
}

void add_bench(CLI::App& command, Options& options) {
  std::vector<std::string> names;
  for (const coppice::NamedBench& bench : coppice::benches()) names.emplace_back(bench.name);
  command.add_option("WHAT", options.bench)->required()->check(CLI::IsMember(names));
  command.add_option("SCENE", options.scene, "of the trace")->capture_default_str();
  command.add_option("--most", options.most, "words, keys or triangles of the largest size")
      ->check(CLI::Range(4u, 1u << 26))
      ->capture_default_str();
  command.add_option("--only", options.only, "only rows of whose name and input this is a part")
      ->type_name("TEXT[,TEXT...]")
      ->delimiter(',');
  command
      .add_option("--builder", options.builders,
                  "of build and trace; default: all for build, gpu-ploc for trace")
      ->delimiter(',')
      ->check(CLI::IsMember(device_builder_names()));
  command.add_option("--runs", options.runs, "that count, after a warm-up until the median is stable")
      ->check(CLI::Range(1u, 10000u))
      ->capture_default_str();
  command.add_option("--csv", options.csv, "write the table to FILE")->type_name("FILE");
  add_view(command, options);
  add_ploc(command, options);
  add_device(command, options);
}

void add_tune(CLI::App& command, Options& options) {
  command.add_option("--most", options.most, "keys that the sort is measured on")
      ->check(CLI::Range(4u, 1u << 26))
      ->capture_default_str();
  command.add_option("--runs", options.runs, "of each variant, after a warm-up until the median is stable")
      ->check(CLI::Range(1u, 10000u))
      ->capture_default_str();
  add_device(command, options);
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("GPU-resident BVH builder and ray tracer");
  app.require_subcommand(0, 1);
  app.set_help_all_flag("--help-all", "Help of all commands");

  CLI::App* const render = app.add_subcommand("render", "build, trace, write the picture");
  render->add_option("-o,--output", options.output)->capture_default_str();
  render->add_option("--tracer", options.tracer)->check(CLI::IsMember({"gpu", "cpu"}))->capture_default_str();
  render->add_flag("--kernels", options.kernels, "print the time of every kernel; takes the frame once more");
  add_picture(*render, options);
  CLI::App* const build =
      app.add_subcommand("build", "build only: time of every kernel, quality of the tree");
  build->add_option("--runs", options.runs, "after a warm-up")
      ->check(CLI::Range(1u, 10000u))
      ->capture_default_str();
  build->add_flag("--rounds", options.rounds, "a table of the rounds of PLOC on the device");
  build->add_flag("--wide", options.wide, "then convert the tree to wide nodes on the device");
  CLI::App* const lockstep =
      app.add_subcommand("lockstep", "every stage on device and CPU; the first difference, or none");
  add_picture(*lockstep, options);
  CLI::App* const compare =
      app.add_subcommand("compare", "every builder on these scenes: the report's Table I");
  compare->add_option("SCENE", options.scenes, "default: four generated ones of 500 to 3,000,000 triangles");
  compare->add_option("--builders", options.builders, "default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(builder_names()));
  compare->add_option("--size", options.size, "pixels, default 1024x768")->type_name("WxH");
  compare->add_option("--timeout", options.timeout_seconds, "seconds a row may take")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  compare->add_option("--markdown", options.markdown, "write the tables to FILE")->type_name("FILE");
  compare->add_option("--plot", options.plot, "write build time against frame time as SVG")
      ->type_name("FILE");
  compare->add_option("--device", options.device, "part of a device's name, or its index")
      ->type_name("NAME|INDEX");
  add_ploc(*compare, options);
  CLI::App* const stability =
      app.add_subcommand("stability", "hard cases and hard rays, with every intersection test");
  add_stability(*stability, options);
  CLI::App* const bench =
      app.add_subcommand("bench", "times of sort, scan, PLOC, build or trace, results checked first");
  add_bench(*bench, options);
  CLI::App* const tune =
      app.add_subcommand("tune", "measure the variants of stages on this device, and keep the fastest");
  add_tune(*tune, options);
  for (CLI::App* const command : {render, lockstep, compare, bench}) add_intersection(*command, options);
  for (CLI::App* const command : {render, lockstep}) add_tree(*command, options);
  for (CLI::App* const command : {render, compare})
    command->add_option("--runs", options.frames, "build and trace so many times; times are medians")
        ->check(CLI::Range(1u, 10000u))
        ->capture_default_str();
  for (CLI::App* const command : {render, build, compare}) add_leaf_size(*command, options);
  for (CLI::App* const command : {render, build}) add_builder(*command, options, builder_names());
  add_builder(*lockstep, options, device_builder_names());
  for (CLI::App* const command : {render, build, lockstep}) {
    add_scene(*command, options);
    add_ploc(*command, options);
    add_device(*command, options);
    add_trace_events(*command, options);
  }
  CLI::App* const scenes = app.add_subcommand("scenes", "the built-in scenes");
  scenes->add_flag("--hard", options.hard, "the inputs that are hard on builders and tracers instead");
  CLI::App* const devices = app.add_subcommand("devices", "the Vulkan devices");
  for (CLI::App* const command : {render, build, lockstep, compare, stability, bench, tune, scenes, devices})
    add_common(*command, options);

  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A command (see --help)");
    for (const std::string& error : {parse_size(options), check_camera(options)}) {
      if (!error.empty()) throw CLI::ValidationError(error);
    }
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "coppice: %s\n", error.what());
    return 2;
  }
  for (const std::string& file :
       {options.json, options.trace_events, options.markdown, options.plot, options.csv}) {
    if (!file.empty() && file != "-") coppice::check_writable(file);
  }
  if (*render) return run_render(options);
  if (*build) return run_build(options);
  if (*lockstep) return run_lockstep(options);
  if (*compare) return run_compare(options);
  if (*stability) return run_stability(options);
  if (*bench) return run_bench(options);
  if (*tune) return run_tune(options);
  if (*scenes) return run_scenes(options);
  return run_devices(options);
}

}  // namespace

int main(int argc, char** argv) {
  // Memory that one build gives back serves the next: fetching it from the kernel anew, page by page, takes
  // up to half of a build of a million triangles.
#ifdef M_MMAP_MAX
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "coppice: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "coppice: %s\n", error.what());
  }
  return 1;
}
