#include "scene/write_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <exception>
#include <string>

#include "scene/write_file.h"

namespace coppice {

namespace {

// The library goes back to the beginning to write where its lines are.
class ExrBytes : public Imf::OStream {
 public:
  ExrBytes() : OStream("picture") {}

  void write(const char* from, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    bytes_.replace(at_, size, from, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::string encode(std::uint32_t width, std::uint32_t height, std::span<const glm::vec3> rgb) {
  constexpr const char* channels[] = {"R", "G", "B"};
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  auto* const first = const_cast<char*>(reinterpret_cast<const char*>(rgb.data()));  // only read
  for (std::size_t i = 0; i < 3; ++i) {
    header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
    frame.insert(channels[i], Imf::Slice(Imf::FLOAT, first + i * sizeof(float), sizeof(glm::vec3),
                                         sizeof(glm::vec3) * width));
  }
  ExrBytes stream;
  {
    Imf::OutputFile file(stream, header, 0);  // no threads
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(height));
  }
  return stream.bytes();
}

}  // namespace

void write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               std::span<const glm::vec3> rgb) {
  check_writable(path);
  if (width == 0 || height == 0 || std::uint64_t{width} * height != rgb.size()) {
    fail_to_write(path, std::to_string(width) + "x" + std::to_string(height) +
                            " pixels are not what the picture holds");
  }
  std::string bytes;
  try {
    bytes = encode(width, height, rgb);
  } catch (const std::exception& error) {
    fail_to_write(path, error.what());
  }
  write_file(path, bytes);
}

}  // namespace coppice
