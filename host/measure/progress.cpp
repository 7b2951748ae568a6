#include "measure/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>

#include "scene/load_obj.h"

namespace coppice {

Progress::Progress(std::string label, std::uint32_t steps)
    : label_(std::move(label)), steps_(steps), shown_(isatty(STDERR_FILENO)) {
  draw();
}

Progress::~Progress() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

void Progress::advance(std::uint32_t done) {
  if (done == done_) return;
  done_ = done;
  draw();
}

void Progress::draw() const {
  if (!shown_) return;
  constexpr std::uint32_t width = 30;
  const std::uint32_t filled = steps_ ? std::min(done_, steps_) * width / steps_ : 0;
  std::fprintf(stderr, "\r%s [%s%s] %u/%u", label_.c_str(), std::string(filled, '#').c_str(),
               std::string(width - filled, ' ').c_str(), done_, steps_);
}

void show_loading() {
  static constexpr std::uint32_t steps = 50;
  struct Loading {
    std::mutex mutex;
    std::unique_ptr<Progress> bar;
    std::uint32_t shown = 0;
  };
  show_load_progress = [loading = std::make_shared<Loading>()](const std::string& name, double done) {
    const std::lock_guard lock(loading->mutex);
    if (!loading->bar) {
      loading->bar = std::make_unique<Progress>("loading " + name, steps);
      loading->shown = 0;
    }
    for (; loading->shown < static_cast<std::uint32_t>(done * steps); ++loading->shown) loading->bar->step();
    if (done >= 1) loading->bar.reset();
  };
}

}  // namespace coppice
