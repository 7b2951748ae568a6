#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "scene/input_error.h"
#include "scene/write_exr.h"
#include "support/read_exr.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

class WriteExr : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("coppice_write_exr_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  fs::path folder_;
};

constexpr float inf = std::numeric_limits<float>::infinity();

TEST_F(WriteExr, KeepsEveryBitOfEveryPixelInItsPlace) {
  constexpr std::uint32_t width = 37, height = 41;  // more than the 16 lines that are compressed together
  std::vector<glm::vec3> pixels;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const auto x = static_cast<float>(i);
    pixels.emplace_back(x, 1 / (x + 1), -x * 1e30f);
  }
  pixels[1] = {inf, -inf, std::numeric_limits<float>::quiet_NaN()};
  pixels[2] = {std::numeric_limits<float>::denorm_min(), -0.0f, std::numeric_limits<float>::max()};
  write_exr(folder_ / "a.exr", width, height, pixels);
  const ReadExr read = read_exr(folder_ / "a.exr");
  EXPECT_EQ(read.width, width);
  EXPECT_EQ(read.height, height);
  EXPECT_EQ(read.channels, (std::vector<std::string>{"B", "G", "R"}));
  ASSERT_EQ(read.rgb.size(), pixels.size());
  EXPECT_EQ(std::memcmp(read.rgb.data(), pixels.data(), pixels.size() * sizeof(glm::vec3)), 0);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WriteExr, TheSamePictureIsTheSameFile) {
  const std::vector<glm::vec3> pixels(12, {1, 2, 3});
  const auto content = [&](const char* name) {
    write_exr(folder_ / name, 4, 3, pixels);
    std::ifstream file(folder_ / name, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  EXPECT_EQ(content("a.exr"), content("b.exr"));
}

TEST_F(WriteExr, ReplacesAFileWholeOrNotAtAll) {
  std::ofstream(folder_ / "a.exr") << "old";
  write_exr(folder_ / "a.exr", 1, 1, std::vector<glm::vec3>(1));
  EXPECT_EQ(read_exr(folder_ / "a.exr").rgb.size(), 1u);
  EXPECT_EQ(file_count(), 1u);
  EXPECT_THROW(write_exr(folder_ / "none" / "a.exr", 1, 1, std::vector<glm::vec3>(1)), InputError);
  if (fs::exists("/dev/full")) {
    EXPECT_THROW(write_exr("/dev/full", 1, 1, std::vector<glm::vec3>(1)), InputError);
  }
}

TEST_F(WriteExr, ASizeThatIsNotThePicturesIsAnErrorAndLeavesNothing) {
  const std::vector<glm::vec3> pixels(6);
  EXPECT_THROW(write_exr(folder_ / "a.exr", 0, 0, {}), InputError);
  EXPECT_THROW(write_exr(folder_ / "a.exr", 4, 2, pixels), InputError);
  EXPECT_THROW(write_exr(folder_ / "a.exr", 1u << 31, 1u << 31, pixels), InputError);
  EXPECT_EQ(file_count(), 0u);
}

}  // namespace
}  // namespace coppice
