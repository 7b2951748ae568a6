#pragma once

#include <optional>
#include <string>
#include <vector>

namespace coppice {

struct ChildResult {
  bool timed_out = false;
  int exit_status = 0;
  std::string output;  // what it wrote to stdout
  std::string error;   // the last line it wrote to stderr
};

// Runs this program with other arguments and waits at most so long; then the child is killed.
// Throws std::runtime_error if it cannot be started.
ChildResult run_self(const std::vector<std::string>& arguments, double limit_seconds);

}  // namespace coppice
