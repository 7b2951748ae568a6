#include "measure/trace_events.h"

#include <nlohmann/json.hpp>

#include "scene/write_file.h"

namespace coppice {

void TraceEvents::add(std::span<const Step> steps, const Recorder::Times& times) {
  for (std::size_t i = 0; i < times.steps_ms.size(); ++i) {
    if (events_.size() < most_events) {
      events_.push_back({step_name(steps[i]), times.steps_ms[i]});
    } else {
      ++left_out_;
    }
  }
}

void TraceEvents::write(const std::string& path, const CheckedDevice& device) const {
  if (path.empty()) return;
  if (left_out_ > 0)
    device.note(path + ": the first " + std::to_string(events_.size()) + " events, without " +
                std::to_string(left_out_) + " more");
  std::string text = "{\"traceEvents\":[";
  double start_us = 0;
  for (const Event& event : events_) {
    const Json json = {{"name", event.name},     {"ph", "X"}, {"ts", start_us},
                       {"dur", event.ms * 1000}, {"pid", 1},  {"tid", 1}};
    if (&event != events_.data()) text += ',';
    text += json.dump();
    start_us += event.ms * 1000;
  }
  write_file(path, text + "],\"displayTimeUnit\":\"ms\"}\n");
}

}  // namespace coppice
