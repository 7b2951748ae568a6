#include "apps/command_line.h"

#include <algorithm>
#include <cstdio>

#include "apps/command.h"
#include "apps/option_rules.h"
#include "measure/comparison_text.h"
#include "scene/printable.h"
#include "scene/write_file.h"

namespace coppice {
namespace {

constexpr NamedCommand commands[] = {
    {"render", "build, trace, write the picture", make_render},
    {"view", "the scene in a window, with what it costs", make_view},
    {"build", "build only: time of every kernel, quality of the tree", make_build},
    {"lockstep", "every stage on device and CPU; the first difference, or none", make_lockstep},
    {"compare", "every builder on these scenes: the report's Table I", make_compare},
    {"stability", "hard cases and hard rays, with every intersection test", make_stability},
    {"bench", "times of sort, scan, PLOC, build or trace, results checked first", make_bench},
    {"tune", "measure the variants of stages on this device, and keep the fastest", make_tune},
    {"animate", "rebuild every frame; frame times, pictures, a video", make_animate},
    {"effects", "what the scene calls for, and what each effect costs", make_effects},
    {"scenes", "the built-in scenes", make_scenes},
    {"devices", "the Vulkan devices", make_devices},
};

std::string command_names() {
  std::string names;
  for (const NamedCommand& command : commands) names.append(names.empty() ? "" : ", ").append(command.name);
  return names;
}

// The first word is the command's name. CLI11 would call another one an argument that was not expected.
void check_command_name(int argc, char** argv) {
  if (argc < 2) throw CLI::RequiredError("A command (" + command_names() + "; see --help)");
  const std::string_view name = argv[1];
  if (name.starts_with('-') ||
      std::ranges::any_of(commands, [&](const auto& one) { return one.name == name; }))
    return;
  throw CLI::ValidationError("unknown command '" + printable(name) + "': there are " + command_names());
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("GPU-resident BVH builder and ray tracer");
  app.require_subcommand(0, 1);
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.set_version_flag("--version", "coppice " COPPICE_VERSION);
  std::vector<std::unique_ptr<Command>> made;
  for (const NamedCommand& named : commands) {
    CLI::App& its = *app.add_subcommand(named.name, named.summary);
    Command& command = *made.emplace_back(named.make());
    command.add_options(its);
    its.add_option("--json", command.files.json, "write what was measured to FILE, - for stdout")
        ->type_name("FILE");
  }
  Command* command = nullptr;
  try {
    check_command_name(argc, argv);
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A command (see --help)");
    const CLI::App& chosen = *app.get_subcommands().front();
    const auto named =
        std::ranges::find_if(commands, [&](const auto& one) { return one.name == chosen.get_name(); });
    command = made[static_cast<std::size_t>(named - commands)].get();
    command->check(chosen);
    check_outputs(chosen, command->files, command->scenes());
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "coppice: %s\n", one_line(error.what()).c_str());
    return 2;
  }
  const OutputOptions& files = command->files;
  for (const std::string& file : {files.json, files.trace_events, files.markdown, files.plot, files.csv}) {
    if (!file.empty() && file != "-") check_writable(file);
  }
  return command->run();
}

}  // namespace coppice
