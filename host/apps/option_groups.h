#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "measure/builder_choice.h"
#include "measure/refine.h"
#include "pipeline/checked_device.h"
#include "pipeline/trace_plan.h"
#include "render/show.h"
#include "render/update_chooser.h"
#include "scene/scene_source.h"

namespace coppice {

// Options that several commands have, a function a group, each for a struct of the libraries.

// A picture, its size and camera first as they are written.
struct PictureOptions {
  std::string size, camera_text;
  TraceOptions trace{};          // holds the size, parsed
  std::vector<double> camera{};  // see given_view; empty: the scene's
};

// Which device, and what is left to it.
struct DeviceSetup {
  DeviceOptions options{};
  DeviceChoices choices{};
};

std::vector<std::string> builder_names();  // of CPU and device
std::vector<std::string> device_builder_names();

void add_scene(CLI::App& app, SceneOptions& scene);
void add_builder(CLI::App& app, BuilderChoice& builder, const std::vector<std::string>& names);
void add_leaf_size(CLI::App& app, BuilderChoice& builder);
void add_lookback(CLI::App& app, DeviceChoices& choices);
void add_ploc(CLI::App& app, BuilderChoice& builder,
              DeviceChoices& choices);  // and what else decides how a tree is built on the device
void add_tree(CLI::App& app, WalkChoice& walk);
void add_intersection(CLI::App& app, TraceOptions& trace);
void add_size(CLI::App& app, PictureOptions& picture);
void add_view(CLI::App& app, PictureOptions& picture, std::string& up);     // size and camera
void add_picture(CLI::App& app, PictureOptions& picture, std::string& up);  // view and samples
void add_tone(CLI::App& app, ToneMapping& tone);                            // and exposure
void add_refine(CLI::App& app, RefineLimits& refine);
void add_error(CLI::App& app, RefineLimits& refine, const std::string& help);
void add_effects(CLI::App& app, SceneOptions& scene);
void add_lens(CLI::App& app, SceneOptions& scene);
void add_show(CLI::App& app, ShowOptions& show);
void add_update(CLI::App& app, Update& update);
void add_named_device(CLI::App& app, DeviceOptions& device);
void add_device(CLI::App& app, DeviceOptions& device);  // and whether to validate
void add_trace_events(CLI::App& app, std::string& file);
void add_runs(CLI::App& app, std::uint32_t& runs, const std::string& help);

// What render, build and lockstep have in common.
void add_scene_and_build(CLI::App& app, SceneOptions& scene, BuilderChoice& builder, DeviceSetup& device,
                         const std::vector<std::string>& names);

// Parses size and camera. Throws CLI::ValidationError naming the option.
void parse_view(PictureOptions& picture);

// The words that those options take for what `picture` and the others say.
std::string word_of_lookback(LookbackChoice lookback);
std::string word_of_triangle_test(std::uint32_t triangle_test);
std::string word_of_box_test(std::uint32_t box_test);
std::string word_of_morton_bits(std::uint32_t bits);

}  // namespace coppice
