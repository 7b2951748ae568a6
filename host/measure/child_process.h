#pragma once

#include <string>
#include <vector>

namespace coppice {

struct ChildResult {
  bool timed_out = false;
  bool could_not_start = false;
  int exit_status = 0;             // -1: ended by a signal
  std::string output;              // what it wrote to stdout
  std::string error;               // the last line it wrote to stderr, or the signal that ended it
  std::vector<std::string> notes;  // the lines before that begin with "note: "
};

// Runs this program with other arguments and waits at most so long. The limit is a timer of the child itself,
// and the child dies with this process, however that ends: no child outlives who waits for it. It leads a
// process group of its own, which ends with it.
// Throws std::runtime_error if it cannot be started.
ChildResult run_self(const std::vector<std::string>& arguments, double limit_seconds);

// The same with another program, which is looked for in PATH.
ChildResult run_program(const std::string& name, const std::vector<std::string>& arguments,
                        double limit_seconds);

}  // namespace coppice
