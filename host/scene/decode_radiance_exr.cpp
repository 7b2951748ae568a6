#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "scene/environment.h"
#include "scene/input_error.h"

namespace coppice {

namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 27;

class ExrInput : public Imf::IStream {
 public:
  explicit ExrInput(std::string_view bytes) : IStream("image"), bytes_(bytes) {}

  bool read(char to[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (at_ > bytes_.size() || bytes_.size() - at_ < size) throw std::runtime_error("it ends early");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

RadianceImage read_radiance(std::string_view bytes) {
  ExrInput stream(bytes);
  Imf::InputFile file(stream, 0);  // no threads
  const auto window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  constexpr std::int64_t most = MAX_RADIANCE_SIDE;
  if (width < 1 || height < 1 || width > most || height > most)
    throw std::runtime_error(std::to_string(width) + " by " + std::to_string(height) +
                             " pixels, expected from 1 to " + std::to_string(most) + " a side");
  if (width * height > most_pixels)
    throw std::runtime_error(std::to_string(width * height) + " pixels, expected at most " +
                             std::to_string(most_pixels));
  constexpr const char* channels[] = {"R", "G", "B"};
  for (const char* const channel : channels) {
    const Imf::Channel* const found = file.header().channels().findChannel(channel);
    if (!found || found->xSampling != 1 || found->ySampling != 1)
      throw std::runtime_error("expected channels R, G and B, each with a value a pixel");
  }
  RadianceImage radiance{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  radiance.pixels.resize(std::size_t{radiance.width} * radiance.height);
  const std::size_t row = sizeof(glm::vec3) * radiance.width;
  // The library counts pixels from the corner (0, 0), wherever the window is.
  auto* const first = reinterpret_cast<char*>(radiance.pixels.data()) -
                      (window.min.x * static_cast<std::ptrdiff_t>(sizeof(glm::vec3)) +
                       window.min.y * static_cast<std::ptrdiff_t>(row));
  Imf::FrameBuffer frame;
  for (std::size_t i = 0; i < 3; ++i)
    frame.insert(channels[i], Imf::Slice(Imf::FLOAT, first + i * sizeof(float), sizeof(glm::vec3), row));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return radiance;
}

}  // namespace

RadianceImage decode_radiance_exr(std::string_view bytes) {
  try {
    return read_radiance(bytes);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::string what = error.what();
    if (const std::size_t line = what.find('\n'); line != std::string::npos) what.resize(line);
    throw InputError("no OpenEXR image that can be read (" + what.substr(0, 300) + ")");
  }
}

}  // namespace coppice
