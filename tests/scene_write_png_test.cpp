#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include "scene/input_error.h"
#include "scene/write_file.h"
#include "scene/write_png.h"

namespace coppice {
namespace {

class WritePng : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("coppice_write_png_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  std::string content(const std::filesystem::path& path) const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // The message of the error that either function throws for this path; they must agree.
  static std::string error_for(const std::filesystem::path& path) {
    const std::vector<std::uint32_t> pixel(1);
    std::string from_check, from_write;
    try {
      check_writable(path);
    } catch (const InputError& error) {
      from_check = error.what();
    }
    try {
      write_png(path, 1, 1, pixel);
    } catch (const InputError& error) {
      from_write = error.what();
    }
    EXPECT_EQ(from_check, from_write);
    return from_write;
  }

  std::filesystem::path folder_;
};

TEST_F(WritePng, KeepsPixelsAndTheirOrder) {
  const std::vector<std::uint32_t> pixels = {0xff0000ff, 0xff00ff00, 0xffff0000, 0x80402010, 0, 0xffffffff};
  write_png(folder_ / "a.png", 3, 2, pixels);
  int width = 0, height = 0, channels = 0;
  unsigned char* const read = stbi_load((folder_ / "a.png").c_str(), &width, &height, &channels, 4);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      EXPECT_EQ(read[4 * i + channel], (pixels[i] >> (8 * channel)) & 0xff) << "pixel " << i;
    }
  }
  stbi_image_free(read);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WritePng, ReplacesAFile) {
  std::ofstream(folder_ / "a.png") << "old";
  write_png(folder_ / "a.png", 1, 1, std::vector<std::uint32_t>(1));
  EXPECT_TRUE(content(folder_ / "a.png").starts_with("\x89PNG"));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WritePng, WritesThroughALink) {
  std::ofstream(folder_ / "a.png") << "old";
  std::filesystem::create_symlink("a.png", folder_ / "link.png");
  write_png(folder_ / "link.png", 1, 1, std::vector<std::uint32_t>(1));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.png"));
  EXPECT_TRUE(content(folder_ / "a.png").starts_with("\x89PNG"));
}

TEST_F(WritePng, WritesThroughALinkToWhatIsNotThereYet) {
  std::filesystem::create_symlink("a.png", folder_ / "link.png");
  std::filesystem::create_symlink("link.png", folder_ / "second.png");
  write_png(folder_ / "second.png", 1, 1, std::vector<std::uint32_t>(1));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.png"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "second.png"));
  EXPECT_TRUE(content(folder_ / "a.png").starts_with("\x89PNG"));
  EXPECT_EQ(file_count(), 3u);
}

TEST_F(WritePng, ALinkToItselfIsAnError) {
  std::filesystem::create_symlink("link.png", folder_ / "link.png");
  EXPECT_NE(error_for(folder_ / "link.png"), "");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(WritePng, AMissingFolderIsAnError) {
  const auto path = folder_ / "none" / "a.png";
  EXPECT_EQ(error_for(path), path.string() + ": cannot write: no such directory");
}

TEST_F(WritePng, AFolderIsAnError) {
  EXPECT_EQ(error_for(folder_), folder_.string() + ": cannot write: is a directory");
}

TEST_F(WritePng, AFileInPlaceOfAFolderIsAnError) {
  std::ofstream(folder_ / "file") << "old";
  const auto path = folder_ / "file" / "a.png";
  EXPECT_EQ(error_for(path), path.string() + ": cannot write: no such directory");
  EXPECT_EQ(content(folder_ / "file"), "old");
}

TEST_F(WritePng, ANameTooLongIsAnErrorAndLeavesNothing) {
  EXPECT_NE(error_for(folder_ / std::string(300, 'a')), "");
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(WritePng, AnEmptyNameIsAnError) { EXPECT_EQ(error_for(""), "cannot write: no file name given"); }

TEST_F(WritePng, AFullDiskIsAnErrorAndTheDeviceStays) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_png("/dev/full", 1, 1, std::vector<std::uint32_t>(1)), InputError);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(WritePng, ASizeThatIsNotThePicturesIsAnErrorAndLeavesNothing) {
  const std::vector<std::uint32_t> pixels(6);
  EXPECT_THROW(write_png(folder_ / "a.png", 0, 0, {}), InputError);
  EXPECT_THROW(write_png(folder_ / "a.png", 4, 2, pixels), InputError);
  EXPECT_THROW(write_png(folder_ / "a.png", 1u << 31, 1u << 31, pixels), InputError);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(WritePng, CheckLeavesNothingBehindAndAFileUntouched) {
  check_writable(folder_ / "new.png");
  EXPECT_EQ(file_count(), 0u);
  std::ofstream(folder_ / "a.png") << "old";
  check_writable(folder_ / "a.png");
  EXPECT_EQ(content(folder_ / "a.png"), "old");
  EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace coppice
