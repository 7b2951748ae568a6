#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "apps/option_rules.h"
#include "scene/printable.h"

namespace coppice {

namespace {

namespace fs = std::filesystem;

struct Output {
  const char* option;
  const char* said;  // in messages
  std::string OutputOptions::*file;
  std::vector<std::string> endings;  // what the file's name may end in; none: anything
};

const std::vector<Output>& all_outputs() {
  static const std::vector<Output> outputs = {
      {"--output", "-o (--output)", &OutputOptions::picture, {".png", ".exr"}},
      {"--json", "--json", &OutputOptions::json, {}},
      {"--trace-events", "--trace-events", &OutputOptions::trace_events, {}},
      {"--markdown", "--markdown", &OutputOptions::markdown, {}},
      {"--plot", "--plot", &OutputOptions::plot, {".svg"}},
      {"--csv", "--csv", &OutputOptions::csv, {}}};
  return outputs;
}

// What there is at the end of links, the last of which may point to nothing yet.
fs::path without_links(fs::path path) {
  std::error_code error;
  for (int links = 0; links < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : whole;
}

bool is_device(const fs::path& path) {
  std::error_code error;
  return fs::is_character_file(fs::status(path, error));
}

// Two names of one file. What is written to devices such as /dev/null is not kept, and may go there twice.
bool same_file(const fs::path& a, const fs::path& b) {
  if (is_device(a)) return false;
  std::error_code error;
  return fs::equivalent(a, b, error) || without_links(a) == without_links(b);
}

// The file or the pipe that stdout is.
bool is_stdout(const fs::path& path) {
  struct stat file, standard;
  return stat(path.c_str(), &file) == 0 && fstat(STDOUT_FILENO, &standard) == 0 && !S_ISCHR(file.st_mode) &&
         file.st_dev == standard.st_dev && file.st_ino == standard.st_ino;
}

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

void check_name(const Output& output, const fs::path& path) {
  const std::string option = output.said;
  if (path.empty()) throw CLI::ValidationError(option + ": no file name given");
  if (path == "-") {
    throw CLI::ValidationError(option +
                               ": '-' is no file; only --json writes to stdout (./- is a file of that name)");
  }
  if (output.endings.empty() || !path.has_extension()) return;
  if (std::ranges::count(output.endings, lower(path.extension())) > 0) return;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return;  // a device or a pipe has whatever name
  std::string endings = output.endings[0];
  for (std::size_t i = 1; i < output.endings.size(); ++i) endings += " or " + output.endings[i];
  throw CLI::ValidationError(option + ": '" + printable(path) + "' does not end in " + endings +
                             ", and no other format is written");
}

void check_is_no_scene(const Output& output, const fs::path& path, const fs::path& scene) {
  std::error_code error;
  if (!scene.has_extension() || !fs::equivalent(path, scene, error)) return;  // built-in names have none
  throw CLI::ValidationError(std::string(output.said) + ": '" + printable(path) +
                             "' is the scene, which would be overwritten");
}

}  // namespace

bool is_exr(const std::string& file) { return lower(fs::path(file).extension()) == ".exr"; }

void check_outputs(const CLI::App& app, const OutputOptions& files, const std::vector<std::string>& scenes) {
  std::vector<const Output*> used;
  for (const Output& output : all_outputs()) {
    const CLI::Option* const option = app.get_option_no_throw(output.option);
    const std::string& file = files.*output.file;
    if (!option || (option->count() == 0 && file.empty())) continue;
    if (output.file == &OutputOptions::json && file == "-") continue;
    check_name(output, file);
    used.push_back(&output);
  }
  for (const Output* output : used) {
    const std::string& file = files.*output->file;
    if (is_stdout(file)) {
      throw CLI::ValidationError(std::string(output->said) + ": '" + printable(fs::path(file)) +
                                 "' is where stdout goes; two outputs to one file");
    }
    for (const std::string& scene : scenes) check_is_no_scene(*output, file, scene);
    for (const Output* other : used) {
      if (other == output) break;
      if (!same_file(file, files.*other->file)) continue;
      throw CLI::ValidationError(std::string(other->said) + " and " + output->said +
                                 " name one file: " + printable(fs::path(file)));
    }
  }
}

}  // namespace coppice
