#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

namespace coppice {

// The files that a command may write; "": none.
struct OutputOptions {
  std::string picture;
  std::string json;  // - for stdout
  std::string trace_events, markdown, plot, csv;

  // Whether the report for people may go to stdout.
  bool talks() const { return json != "-"; }
};

// A command of the program: what it is told, and what it does. Each has options of its own, made of those of
// the libraries it calls.
class Command {
 public:
  virtual ~Command() = default;

  virtual void add_options(CLI::App& app) = 0;

  // Refuses what has been parsed and makes no sense together. Throws CLI::ValidationError.
  virtual void check(const CLI::App&) {}

  // The scenes that it reads.
  virtual std::vector<std::string> scenes() const { return {}; }

  // Returns the exit status, or throws InputError, DeviceError or LayoutError.
  virtual int run() = 0;

  OutputOptions files;
};

// How the command line knows one.
struct NamedCommand {
  const char* name;
  const char* summary;
  std::unique_ptr<Command> (*make)();
};

std::unique_ptr<Command> make_render();
std::unique_ptr<Command> make_view();
std::unique_ptr<Command> make_build();
std::unique_ptr<Command> make_lockstep();
std::unique_ptr<Command> make_compare();
std::unique_ptr<Command> make_stability();
std::unique_ptr<Command> make_bench();
std::unique_ptr<Command> make_tune();
std::unique_ptr<Command> make_animate();
std::unique_ptr<Command> make_effects();
std::unique_ptr<Command> make_scenes();
std::unique_ptr<Command> make_devices();

}  // namespace coppice
