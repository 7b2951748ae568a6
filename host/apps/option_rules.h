#pragma once

#include <CLI/CLI.hpp>

#include "apps/options.h"

namespace coppice {

// Refuses what the command would take without a word and not do: an option that was given and has no effect
// beside the others, such as --rounds with a builder that has none. `command` has been parsed into `options`.
// Exempt are --device and the parameters of builders (--radius, --morton-bits, --leaf-size): a script may
// name them once for all builders. Throws CLI::ValidationError with one line that names the option and says
// what it needs.
void check_options_matter(const CLI::App& command, const Options& options);

// Refuses outputs that would not come out as named, before any work: no file name, "-" for what does not go
// to stdout, a picture or plot whose ending promises another format, two outputs to one file (whatever its
// spelling, links followed), or an output over the scene that is read. The option --json alone takes "-".
// Throws CLI::ValidationError with one line that names the option or both.
void check_outputs(const CLI::App& command, const Options& options);

}  // namespace coppice
