#pragma once

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace coppice {

struct ReadExr {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  // all of 32-bit float
  std::vector<glm::vec3> rgb;         // rows top to bottom
};

// Throws what the library throws for a file that it does not read.
inline ReadExr read_exr(const std::filesystem::path& path) {
  Imf::InputFile file(path.c_str(), 0);
  const auto window = file.header().dataWindow();
  ReadExr read;
  read.width = static_cast<std::uint32_t>(window.max.x - window.min.x + 1);
  read.height = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
  read.rgb.resize(std::size_t{read.width} * read.height);
  const Imf::ChannelList& channels = file.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    if (channel.channel().type == Imf::FLOAT) read.channels.emplace_back(channel.name());
  }
  constexpr const char* names[] = {"R", "G", "B"};
  Imf::FrameBuffer frame;
  auto* const first = reinterpret_cast<char*>(read.rgb.data());
  for (std::size_t i = 0; i < 3; ++i)
    frame.insert(names[i], Imf::Slice(Imf::FLOAT, first + i * sizeof(float), sizeof(glm::vec3),
                                      sizeof(glm::vec3) * read.width));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return read;
}

}  // namespace coppice
