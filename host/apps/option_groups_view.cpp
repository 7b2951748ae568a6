#include <charconv>

#include "apps/option_groups.h"
#include "scene/printable.h"
#include "scene/view.h"

namespace coppice {
namespace {

constexpr std::uint32_t max_side = 16383;  // a square of it is the most that write_png takes

// "1024x768" into width and height, each 1 to max_side.
std::string parse_size(PictureOptions& picture) {
  if (picture.size.empty()) return {};
  TraceOptions& trace = picture.trace;
  const char* const end = picture.size.data() + picture.size.size();
  auto [middle, first_error] = std::from_chars(picture.size.data(), end, trace.width);
  const bool first = first_error == std::errc() && middle != end && *middle == 'x';
  const auto [last, second_error] =
      first ? std::from_chars(middle + 1, end, trace.height) : std::from_chars_result{};
  const bool parsed = first && second_error == std::errc() && last == end;
  const auto in_range = [](std::uint32_t side) { return side >= 1 && side <= max_side; };
  if (parsed && in_range(trace.width) && in_range(trace.height)) return {};
  return "--size: '" + picture.size + "' is not WxH with sides of 1 to " + std::to_string(max_side);
}

// Numbers between commas.
std::string parse_camera(PictureOptions& picture) {
  if (picture.camera_text.empty()) return {};
  const std::string& text = picture.camera_text;
  picture.camera.clear();
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    std::string word = text.substr(begin, end == std::string::npos ? end : end - begin);
    word.erase(0, word.starts_with('+') ? 1 : 0);
    double number = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || last != word.data() + word.size())
      return "--camera: '" + printable(std::string_view(word)) + "' is no number";
    picture.camera.push_back(number);
  }
  const std::string complaint = complaint_about_view(picture.camera);
  return complaint.empty() ? std::string() : "--camera: " + complaint;
}

}  // namespace

void parse_view(PictureOptions& picture) {
  for (const std::string& error : {parse_size(picture), parse_camera(picture)}) {
    if (!error.empty()) throw CLI::ValidationError(error);
  }
}

void add_size(CLI::App& app, PictureOptions& picture) {
  app.add_option("--size", picture.size, "pixels, default 1024x768")->type_name("WxH");
}

void add_view(CLI::App& app, PictureOptions& picture, std::string& up) {
  add_size(app, picture);
  app.add_option("--camera", picture.camera_text,
                 "eye, target, vertical field of view in degrees, and what is up in the picture, in the "
                 "coordinates of the file; default: frames the scene")
      ->type_name("X,Y,Z,X,Y,Z[,FOV][,X,Y,Z]")
      ->check([](const std::string& text) { return text.empty() ? "has no numbers" : ""; }, "");
  app.add_option("--up", up, "the axis of the file that points up")
      ->check(CLI::IsMember(std::vector<std::string>(UP_AXES.begin(), UP_AXES.end())))
      ->capture_default_str();
}

void add_picture(CLI::App& app, PictureOptions& picture, std::string& up) {
  add_view(app, picture, up);
  app.add_option("--spp", picture.trace.samples, "samples per pixel")
      ->check(CLI::Range(1u, 65536u))
      ->capture_default_str();
}

}  // namespace coppice
