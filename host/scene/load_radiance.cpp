#include <algorithm>
#include <new>

#include "scene/environment.h"
#include "scene/input_error.h"
#include "scene/obj_file.h"
#include "scene/obj_mtl_files.h"
#include "scene/printable.h"

namespace coppice {

namespace {

float radiance_of(float value) { return value > 0 ? std::min(value, MAX_RADIANCE) : 0.0f; }

RadianceImage checker_radiance() {
  RadianceImage checker{64, 32, {}};
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x)
      checker.pixels.push_back((x / 4 + y / 4) % 2 == 0 ? glm::vec3(1, 0, 1) : glm::vec3(0));
  }
  return checker;
}

}  // namespace

RadianceImage decode_radiance(std::string_view bytes) {
  constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";
  RadianceImage image = bytes.starts_with(exr_magic) ? decode_radiance_exr(bytes)
                        : bytes.starts_with("#?")    ? decode_radiance_hdr(bytes)
                                                     : throw InputError("neither Radiance HDR nor OpenEXR");
  for (glm::vec3& pixel : image.pixels)
    pixel = {radiance_of(pixel.x), radiance_of(pixel.y), radiance_of(pixel.z)};
  return image;
}

RadianceImage load_radiance(const Environment& environment, std::string& warning) {
  const std::string place = printable(std::filesystem::path(environment.folder) / environment.image);
  const auto replaced = [&](const std::string& what) {
    warning = (what.starts_with(place) ? "" : place + ": ") + what + ", a checker takes its place as " +
              environment.origin;
    return checker_radiance();
  };
  try {
    const auto found = MtlFolder(environment.folder).locate(environment.image);
    if (!found) throw InputError("no such file");
    return decode_radiance(read_obj_file(*found).text());
  } catch (const InputError& error) {
    return replaced(error.what());
  } catch (const std::bad_alloc&) {
    return replaced("no memory for the image");
  }
}

}  // namespace coppice
