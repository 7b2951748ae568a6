#include "apps/option_groups.h"

#include <algorithm>
#include <charconv>

#include "builders/registry.h"
#include "interface/ploc.h"
#include "pipeline/build.h"
#include "scene/printable.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace coppice {
namespace {

constexpr std::uint32_t max_side = 16383;  // a square of it is the most that write_png takes

// "1024x768" into width and height, each 1 to max_side.
std::string parse_size(Options& options) {
  if (options.size.empty()) return {};
  const char* const end = options.size.data() + options.size.size();
  auto [middle, first_error] = std::from_chars(options.size.data(), end, options.width);
  const bool first = first_error == std::errc() && middle != end && *middle == 'x';
  const auto [last, second_error] =
      first ? std::from_chars(middle + 1, end, options.height) : std::from_chars_result{};
  const bool parsed = first && second_error == std::errc() && last == end;
  const auto in_range = [](std::uint32_t side) { return side >= 1 && side <= max_side; };
  if (parsed && in_range(options.width) && in_range(options.height)) return {};
  return "--size: '" + options.size + "' is not WxH with sides of 1 to " + std::to_string(max_side);
}

// Numbers between commas.
std::string parse_camera(Options& options) {
  if (options.camera_text.empty()) return {};
  const std::string& text = options.camera_text;
  options.camera.clear();
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    std::string word = text.substr(begin, end == std::string::npos ? end : end - begin);
    word.erase(0, word.starts_with('+') ? 1 : 0);
    double number = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || last != word.data() + word.size())
      return "--camera: '" + printable(std::string_view(word)) + "' is no number";
    options.camera.push_back(number);
  }
  const std::string complaint = complaint_about_view(options.camera);
  return complaint.empty() ? std::string() : "--camera: " + complaint;
}

}  // namespace

void check_view(Options& options) {
  for (const std::string& error : {parse_size(options), parse_camera(options)}) {
    if (!error.empty()) throw CLI::ValidationError(error);
  }
}

void add_named_device(CLI::App& command, Options& options) {
  command.add_option("--device", options.device, "part of a device's name, or its index")
      ->type_name("NAME|INDEX");
}

void add_device(CLI::App& command, Options& options) {
  add_named_device(command, options);
  command.add_flag("--validate", options.validate, "Vulkan validation layers on; a message is a failure");
}

void add_trace_events(CLI::App& command, Options& options) {
  command.add_option("--trace-events", options.trace_events, "write every kernel as a Chrome trace event")
      ->type_name("FILE");
}

void add_scene(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene, "an .obj file or a built-in scene")->capture_default_str();
}

std::vector<std::string> device_builder_names() {
  std::vector<std::string> builders;
  for (const NamedDeviceBuilder& named : device_builders()) builders.emplace_back(named.name);
  return builders;
}

std::vector<std::string> builder_names() {
  std::vector<std::string> builders;
  for (const CpuBuilder& builder : cpu_builders()) builders.emplace_back(builder.name);
  for (std::string& name : device_builder_names()) builders.push_back(std::move(name));
  return builders;
}

void add_builder(CLI::App& command, Options& options, const std::vector<std::string>& names) {
  command.add_option("--builder", options.builder)->check(CLI::IsMember(names))->capture_default_str();
}

void add_leaf_size(CLI::App& command, Options& options) {
  command
      .add_option("--leaf-size", options.leaf_size,
                  "gd16-early: the most references that are not split any further")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
}

void add_lookback(CLI::App& command, Options& options) {
  command
      .add_option("--lookback", options.lookback,
                  "prefix sums by decoupled lookback; auto: where the self-check allows it")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str();
}

void add_ploc(CLI::App& command, Options& options) {
  command
      .add_option("--radius", options.radius, "search radius of PLOC and H-PLOC; other builders have none")
      ->check(CLI::Range(1u, PLOC_MAX_RADIUS))
      ->capture_default_str();
  command
      .add_option("--morton-bits", options.morton_bits,
                  "of the codes PLOC and LBVH sort by; auto: 60 where 30 leave cells crowded")
      ->check(CLI::IsMember({"auto", "30", "60"}))
      ->capture_default_str();
  add_lookback(command, options);
  command
      .add_option(
          "--variants", options.variants,
          "of stages that have some; auto: as tuned, or else default, which goes by the kind of device")
      ->type_name("auto|default|STAGE=VALUE,...")
      ->check([](const std::string& text) {
        Variants variants;
        return text == "auto" || text == "default" ? std::string() : set_variants(text, variants);
      })
      ->capture_default_str();
}

void add_tree(CLI::App& command, Options& options) {
  command
      .add_option(
          "--tree", options.tree,
          "which the device's tracer walks; wide: eight children a node, rays in packets or each by itself, "
          "as the variant of the stage trace says or the option; auto: by that variant, but binary where the "
          "scene has more triangles than the picture rays")
      ->check(CLI::IsMember({"auto", "binary", "wide", "wide-packets", "wide-single"}))
      ->capture_default_str();
}

void add_intersection(CLI::App& command, Options& options) {
  command
      .add_option("--triangle-test", options.triangle_test,
                  "fast: Moeller-Trumbore; watertight: Woop, Benthin and Wald")
      ->check(CLI::IsMember({"auto", "fast", "watertight"}))
      ->capture_default_str();
  command.add_option("--box-test", options.box_test, "robust: slabs widened by the rounding error")
      ->check(CLI::IsMember({"auto", "fast", "robust"}))
      ->capture_default_str();
}

void add_size(CLI::App& command, Options& options) {
  command.add_option("--size", options.size, "pixels, default 1024x768")->type_name("WxH");
}

void add_view(CLI::App& command, Options& options) {
  add_size(command, options);
  command
      .add_option("--camera", options.camera_text,
                  "eye, target, vertical field of view in degrees, and what is up in the picture, in the "
                  "coordinates of the file; default: frames the scene")
      ->type_name("X,Y,Z,X,Y,Z[,FOV][,X,Y,Z]")
      ->check([](const std::string& text) { return text.empty() ? "has no numbers" : ""; }, "");
  command.add_option("--up", options.up, "the axis of the file that points up")
      ->check(CLI::IsMember(std::vector<std::string>(UP_AXES.begin(), UP_AXES.end())))
      ->capture_default_str();
}

void add_picture(CLI::App& command, Options& options) {
  add_view(command, options);
  command.add_option("--spp", options.samples, "samples per pixel")
      ->check(CLI::Range(1u, 65536u))
      ->capture_default_str();
}

}  // namespace coppice
