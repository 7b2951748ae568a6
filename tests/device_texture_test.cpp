// The kernel library of textures and its twin give the same bits, whatever they are asked.
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "kernels/texture_samples.h"
#include "scene/texture.h"
#include "stages/lockstep_executor.h"
#include "support/test_device.h"
#include "twins/texture.h"

namespace coppice {
namespace {

class DeviceTextures : public DeviceTest {};

void texture_samples(const void* bytes) {
  const auto& args = *static_cast<const TextureSamplesArgs*>(bytes);
  for (uint i = 0; i < args.sample_count; ++i) {
    const float* const sample = &args.samples[i * TEXTURE_SAMPLE_WORDS];
    float* const result = &args.results[i * TEXTURE_RESULT_WORDS];
    const uint which = std::bit_cast<uint>(sample[0]);
    const glm::vec4 colour = twins::texture_colour(args.headers, args.texels, args.linear, which,
                                                   {sample[1], sample[2]}, sample[3]);
    for (int channel = 0; channel < 4; ++channel) result[channel] = colour[channel];
    result[6] = twins::twice_texcoord_area(args.corners[i]);
    result[7] = twins::twice_area(args.triangles[i]);
    const float width = twins::cone_width_at(sample[4], 0.01f, 3.0f);
    result[4] = twins::surface_level(result[6], result[7], width, sample[5]);
    result[5] = twins::texture_level(args.headers[which]);
  }
}

std::vector<std::uint32_t> texture_samples_kernel() {
  std::ifstream file(COPPICE_TEST_KERNELS "/texture_samples.spv", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  return words;
}

struct TextureInput {
  std::vector<TextureHeader> headers;
  std::vector<uint> texels;
  std::vector<CornerAttributes> corners;
  std::vector<Triangle> triangles;
  std::vector<float> samples;
};

class TextureInputMaker {
 public:
  TextureInput make(uint sample_count) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {8u, 8u}, {37u, 5u}, {1u, 64u}, {100u, 101u}}) {
      for (uint flags = 0; flags < 32; ++flags) {
        if ((flags & 3) == 3 || (flags >> 2 & 3) == 3) continue;
        add_texture(width, height, flags);
      }
    }
    for (uint i = 0; i < sample_count; ++i) add_sample();
    return std::move(input_);
  }

 private:
  void add_texture(uint width, uint height, uint flags) {
    const uint levels = static_cast<uint>(std::bit_width(std::max(width, height)));
    input_.headers.push_back({static_cast<uint>(input_.texels.size()),
                              width,
                              height,
                              levels,
                              {scaled(1), flags & 1 ? 1.0f : scaled(4)},
                              {scaled(1), 0},
                              flags,
                              0,
                              0,
                              0});
    for (uint level = 0; level < levels; ++level) {
      const uint count = std::max(width >> level, 1u) * std::max(height >> level, 1u);
      for (uint i = 0; i < count; ++i) input_.texels.push_back(static_cast<uint>(random_()));
    }
  }

  void add_sample() {
    const uint which = static_cast<uint>(random_() % input_.headers.size());
    for (const float word : {std::bit_cast<float>(which), number(), number(), number(), number(), number()})
      input_.samples.push_back(word);
    const auto pair = [&] { return vec2(number(), number()); };
    const auto triple = [&] { return vec3(number(), number(), number()); };
    input_.corners.push_back({pair(), pair(), pair(), {}, {}, {}, 0});
    input_.triangles.push_back({triple(), triple(), triple()});
  }

  // Mostly of an everyday size, and at times anything.
  float number() {
    constexpr float odd[] = {0.0f,
                             -0.0f,
                             0.5f,
                             1.0f,
                             -1.0f,
                             2.0f,
                             1e-30f,
                             1e-20f,
                             8388608.0f,
                             3e38f,
                             std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN()};
    if (random_() % 8 == 0) return odd[random_() % std::size(odd)];
    if (random_() % 8 == 0) return std::ldexp(scaled(1), static_cast<int>(random_() % 60) - 30);
    return scaled(6);
  }
  float scaled(float most) { return most * (static_cast<float>(random_() % 65537) / 32768.0f - 1); }

  std::mt19937 random_{5};
  TextureInput input_;
};

TEST_F(DeviceTextures, LockstepOfWhateverIsAsked) {
  constexpr uint count = 20000;
  const TextureInput input = TextureInputMaker().make(count);
  const std::array<float, 256> linear = srgb_to_linear();
  const std::vector<std::uint32_t> kernel = texture_samples_kernel();
  ASSERT_FALSE(kernel.empty());
  const Stage<TextureSamplesArgs, NoConstants> stage{
      {"texture_samples", kernel, texture_samples, nullptr, {}, address_args_of<TextureSamplesArgs>}};
  Layout layout(test_device().properties().max_block_bytes);
  const auto headers = layout.add<TextureHeader>("headers", input.headers.size());
  const auto texels = layout.add<uint>("texels", input.texels.size());
  const auto table = layout.add<float>("linear", linear.size());
  const auto corners = layout.add<CornerAttributes>("corners", count);
  const auto triangles = layout.add<Triangle>("triangles", count);
  const auto samples = layout.add<float>("samples", input.samples.size());
  const auto results = layout.add<float>("results", std::size_t{count} * TEXTURE_RESULT_WORDS);
  LockstepExecutor executor(test_device(), layout);
  executor.upload(headers, std::span<const TextureHeader>(input.headers));
  executor.upload(texels, std::span<const uint>(input.texels));
  executor.upload(table, std::span<const float>(linear));
  executor.upload(corners, std::span<const CornerAttributes>(input.corners));
  executor.upload(triangles, std::span<const Triangle>(input.triangles));
  executor.upload(samples, std::span<const float>(input.samples));
  const auto difference = executor.run([&](Chain& chain) {
    chain.run(stage,
              {chain.at(headers), chain.at(texels), chain.at(table), chain.at(corners), chain.at(triangles),
               chain.at(samples), chain.at(results), count, 0},
              groups_of(count, 32));
  });
  if (difference) {
    FAIL() << difference->slot << "[" << difference->index << "]: " << difference->cpu << " by the twin, "
           << difference->gpu << " by the kernel";
  }
  EXPECT_EQ(executor.stages_run(), 1u);
}

}  // namespace
}  // namespace coppice
