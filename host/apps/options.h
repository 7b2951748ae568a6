#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace coppice {

// What the command line says, of all commands.
struct Options {
  std::string scene = "grove";
  std::string device;  // part of a name or an index; empty: the best one
  std::string json;    // file, - for stdout; empty: none
  std::string trace_events;
  bool validate = false;

  std::string builder = "gpu-ploc";
  std::uint32_t leaf_size = 8;  // of gd16-early
  std::uint32_t radius = 16;
  std::string morton_bits = "auto";  // auto, 30, 60
  std::uint32_t runs = 5;            // of `build`
  bool rounds = false;               // of `build`: a table of the rounds of PLOC
  std::string tree = "auto";         // that the device's tracer walks: auto, binary, wide, wide-...
  bool wide = false;                 // of `build`: convert the tree to wide nodes, too
  std::uint32_t frames = 1;          // of `render`: the whole frame so many times
  bool kernels = false;              // of `render`: once more, to print the time of every kernel
  std::string lookback = "auto";     // auto, on, off
  std::string variants = "auto";     // auto, default, STAGE=VALUE,...

  std::string bench;              // one of benches()
  std::uint32_t most = 1u << 20;  // of `bench`: keys or triangles of the largest size
  std::string csv;                // file; empty: none
  std::vector<std::string> only;  // parts of names of rows; empty: all

  std::vector<std::string> scenes, builders;  // of `compare` and `bench`; empty: the default ones
  double timeout_seconds = 60;
  std::string markdown, plot;  // files; empty: none

  bool hard = false;  // of `scenes`: the hard cases in place of the others

  std::vector<std::string> cases;  // of `stability`; empty: all
  std::uint32_t most_triangles = 2000, rays_of_a_kind = 500, seed_count = 1;
  std::uint64_t seed = 1, leak_rays = 20000;

  std::string output = "coppice.png";
  std::string size;  // WxH as given; `width` and `height` hold it parsed
  std::uint32_t width = 1024, height = 768;
  std::uint32_t samples = 1;
  std::string tracer = "gpu";
  std::string triangle_test = "auto";  // auto, fast, watertight
  std::string box_test = "auto";       // auto, fast, robust
  std::string camera_text;             // as given; `camera` holds its numbers
  std::vector<double> camera;          // see given_view; empty: the scene's
  std::string up = "y";                // one of UP_AXES
};

// One function a command. Each returns the exit status, or throws InputError, DeviceError or LayoutError.
int run_render(const Options& options);
int run_build(const Options& options);
int run_lockstep(const Options& options);
int run_compare(const Options& options);
int run_stability(const Options& options);
int run_bench(const Options& options);
int run_tune(const Options& options);
int run_scenes(const Options& options);
int run_devices(const Options& options);

}  // namespace coppice
