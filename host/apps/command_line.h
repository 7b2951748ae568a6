#pragma once

namespace coppice {

// Parses the arguments, runs the command that they name, and returns the exit status: 2 after one line on
// stderr for arguments that say nothing valid. Throws what the command throws.
int run_command_line(int argc, char** argv);

}  // namespace coppice
