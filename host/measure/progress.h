#pragma once

#include <cstdint>
#include <string>

namespace coppice {

// A progress bar on stderr while it lives; shows nothing where stderr is no terminal.
class Progress {
 public:
  Progress(std::string label, std::uint32_t steps);
  ~Progress();
  void step() { advance(done_ + 1); }
  void advance(std::uint32_t done);  // of the steps

 private:
  void draw() const;

  std::string label_;
  std::uint32_t steps_, done_ = 0;
  bool shown_;
};

// Shows a progress bar for every long scene file that is loaded from now on.
void show_loading();

}  // namespace coppice
