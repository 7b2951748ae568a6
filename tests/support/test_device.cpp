#include "support/test_device.h"

#include <execinfo.h>
#include <unistd.h>

#include <array>
#include <exception>
#include <random>

namespace coppice {

namespace {

// What ends the process on a thread of a driver's or a layer's own: says where that was, beside what.
const std::terminate_handler say_what = std::set_terminate([] {
  std::array<void*, 64> frames;
  backtrace_symbols_fd(frames.data(), backtrace(frames.data(), frames.size()), STDERR_FILENO);
  say_what();
});

}  // namespace

Device& test_device() {
  static Device device({"", true, false});
  return device;
}

void DeviceTest::TearDown() {
  for (const std::string& message : test_device().take_validation_messages()) ADD_FAILURE() << message;
}

TraceOptions test_trace_options(std::uint32_t width, std::uint32_t height) {
  TraceOptions options;
  options.width = width;
  options.height = height;
  options.max_turns = test_device().properties().max_turns();
  return options;
}

std::vector<Triangle> random_triangles(std::uint32_t count, std::uint32_t seed, float size) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    t.a = {next(), next(), next()};
    t.b = t.a + vec3(next(), next(), next()) * size;
    t.c = t.a + vec3(next(), next(), next()) * size;
  }
  return triangles;
}

}  // namespace coppice
