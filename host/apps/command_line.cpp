#include "apps/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "apps/bench.h"
#include "apps/comparison_text.h"
#include "apps/option_groups.h"
#include "apps/option_rules.h"
#include "scene/printable.h"
#include "scene/write_file.h"

namespace coppice {
namespace {

void add_frames(CLI::App& command, Options& options) {
  command.add_option("--runs", options.frames, "build and trace so many times; times are medians")
      ->check(CLI::Range(1u, 10000u))
      ->capture_default_str();
}

// What render, build and lockstep have in common.
void add_scene_and_build(CLI::App& command, Options& options, const std::vector<std::string>& builders) {
  add_scene(command, options);
  add_builder(command, options, builders);
  add_ploc(command, options);
  add_device(command, options);
}

void add_render(CLI::App& command, Options& options) {
  command.add_option("-o,--output", options.output)->capture_default_str();
  command.add_option("--tracer", options.tracer)->check(CLI::IsMember({"gpu", "cpu"}))->capture_default_str();
  command.add_flag("--kernels", options.kernels, "print the time of every kernel; takes the frame once more");
  add_picture(command, options);
  add_intersection(command, options);
  add_tree(command, options);
  add_frames(command, options);
  add_leaf_size(command, options);
  add_trace_events(command, options);
  add_scene_and_build(command, options, builder_names());
}

void add_build(CLI::App& command, Options& options) {
  command.add_option("--runs", options.runs, "after a warm-up")
      ->check(CLI::Range(1u, 10000u))
      ->capture_default_str();
  command.add_flag("--rounds", options.rounds, "a table of the rounds of gpu-ploc");
  command.add_flag("--wide", options.wide, "then convert the tree to wide nodes on the device");
  add_leaf_size(command, options);
  add_trace_events(command, options);
  add_scene_and_build(command, options, builder_names());
}

void add_lockstep(CLI::App& command, Options& options) {
  add_picture(command, options);
  add_intersection(command, options);
  add_tree(command, options);
  add_scene_and_build(command, options, device_builder_names());
}

void add_compare(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scenes, "default: four generated ones of 500 to 3,000,000 triangles");
  command.add_option("--builders", options.builders, "default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(builder_names()));
  add_size(command, options);
  command.add_option("--timeout", options.timeout_seconds, "seconds a row may take")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command.add_option("--markdown", options.markdown, "write the tables to FILE")->type_name("FILE");
  command.add_option("--plot", options.plot, "write build time against frame time as SVG")->type_name("FILE");
  add_named_device(command, options);
  add_intersection(command, options);
  add_frames(command, options);
  add_leaf_size(command, options);
  add_ploc(command, options);
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
  command
      .add_option("--seeds", options.seed_count,
                  "so many seeds from --seed on; of more than one only rows that fail are shown")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  add_ploc(command, options);
  add_device(command, options);
}

void add_bench(CLI::App& command, Options& options) {
  std::vector<std::string> names;
  for (const NamedBench& bench : benches()) names.emplace_back(bench.name);
  command.add_option("WHAT", options.bench)->required()->check(CLI::IsMember(names));
  command.add_option("SCENE", options.scenes, "of the trace; default: grove and hard:detail-on-ground")
      ->expected(1);
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
  add_size(command, options);  // the trace is measured on a quarter of its rays
  add_lookback(command, options);
  add_device(command, options);
}

void add_scenes(CLI::App& command, Options& options) {
  command.add_flag("--hard", options.hard, "the inputs that are hard on builders and tracers instead");
}

struct Command {
  std::string_view name;
  const char* summary;
  void (*add_options)(CLI::App&, Options&);
  int (*run)(const Options&);
};

constexpr Command commands[] = {
    {"render", "build, trace, write the picture", add_render, run_render},
    {"build", "build only: time of every kernel, quality of the tree", add_build, run_build},
    {"lockstep", "every stage on device and CPU; the first difference, or none", add_lockstep, run_lockstep},
    {"compare", "every builder on these scenes: the report's Table I", add_compare, run_compare},
    {"stability", "hard cases and hard rays, with every intersection test", add_stability, run_stability},
    {"bench", "times of sort, scan, PLOC, build or trace, results checked first", add_bench, run_bench},
    {"tune", "measure the variants of stages on this device, and keep the fastest", add_tune, run_tune},
    {"scenes", "the built-in scenes", add_scenes, run_scenes},
    {"devices", "the Vulkan devices", [](CLI::App&, Options&) {}, run_devices},
};

std::string command_names() {
  std::string names;
  for (const Command& command : commands) names.append(names.empty() ? "" : ", ").append(command.name);
  return names;
}

// The first word is the command's name. CLI11 would call another one an argument that was not expected.
void check_command_name(int argc, char** argv) {
  if (argc < 2) throw CLI::RequiredError("A command (" + command_names() + "; see --help)");
  const std::string_view name = argv[1];
  if (name.starts_with('-') || std::ranges::find(commands, name, &Command::name) != std::end(commands))
    return;
  throw CLI::ValidationError("unknown command '" + printable(name) + "': there are " + command_names());
}

}  // namespace

int run_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("GPU-resident BVH builder and ray tracer");
  app.require_subcommand(0, 1);
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.set_version_flag("--version", "coppice " COPPICE_VERSION);
  for (const Command& command : commands) {
    CLI::App& its = *app.add_subcommand(std::string(command.name), command.summary);
    command.add_options(its, options);
    its.add_option("--json", options.json, "write what was measured to FILE, - for stdout")
        ->type_name("FILE");
  }
  try {
    check_command_name(argc, argv);
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A command (see --help)");
    check_view(options);
    check_options_matter(*app.get_subcommands().front(), options);
    check_outputs(*app.get_subcommands().front(), options);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "coppice: %s\n", one_line(error.what()).c_str());
    return 2;
  }
  for (const std::string& file :
       {options.json, options.trace_events, options.markdown, options.plot, options.csv}) {
    if (!file.empty() && file != "-") check_writable(file);
  }
  const std::string name = app.get_subcommands().front()->get_name();
  return std::ranges::find(commands, name, &Command::name)->run(options);
}

}  // namespace coppice
