#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/options.h"

namespace coppice {

// Options that several commands have, a function a group.

std::vector<std::string> builder_names();  // of CPU and device
std::vector<std::string> device_builder_names();

void add_scene(CLI::App& command, Options& options);
void add_builder(CLI::App& command, Options& options, const std::vector<std::string>& names);
void add_leaf_size(CLI::App& command, Options& options);
void add_lookback(CLI::App& command, Options& options);
void add_ploc(CLI::App& command,
              Options& options);  // and what else decides how a tree is built on the device
void add_tree(CLI::App& command, Options& options);
void add_intersection(CLI::App& command, Options& options);
void add_size(CLI::App& command, Options& options);
void add_view(CLI::App& command, Options& options);     // size and camera
void add_picture(CLI::App& command, Options& options);  // view and samples
void add_named_device(CLI::App& command, Options& options);
void add_device(CLI::App& command, Options& options);  // and whether to validate
void add_trace_events(CLI::App& command, Options& options);

// Parses the size into width and height, and checks the camera. Throws CLI::ValidationError naming the
// option.
void check_view(Options& options);

}  // namespace coppice
