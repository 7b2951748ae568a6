#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "apps/command.h"
#include "measure/builder_choice.h"

namespace coppice {

// An option that has an effect only beside others.
struct OptionRule {
  std::string_view option;
  bool matters;
  const char* needs;  // what would make it matter
};

inline constexpr const char* NEEDS_DEVICE =
    "that something runs on the device: --tracer gpu or a builder gpu-...";
inline constexpr const char* NEEDS_DEVICE_BUILDER = "a builder on the device, gpu-...";
inline constexpr const char* NEEDS_DEVICE_TRACER = "--tracer gpu";

// Refuses what the command would take without a word and not do: an option that was given and has no effect
// beside the others, such as --rounds with a builder that has none. Exempt are --device and the parameters of
// builders (--radius, --morton-bits, --leaf-size): a script may name them once for all builders. Throws
// CLI::ValidationError with one line that names the option and says what it needs.
void check_options_matter(const CLI::App& app, std::initializer_list<OptionRule> rules);

// Refuses outputs that would not come out as named, before any work: no file name, "-" for what does not go
// to stdout, a picture or plot whose ending promises another format, two outputs to one file (whatever its
// spelling, links followed), or an output over one of the scenes that are read. The option --json alone takes
// "-". Throws CLI::ValidationError with one line that names the option or both.
void check_outputs(const CLI::App& app, const OutputOptions& files, const std::vector<std::string>& scenes);

// Whether a picture of that name is one of linear radiance.
bool is_exr(const std::string& file);

}  // namespace coppice
