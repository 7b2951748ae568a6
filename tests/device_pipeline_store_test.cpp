// Compiled pipelines are kept between runs, and whatever is wrong with the file does no harm.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/tree_hash.h"
#include "support/device_run.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

class PipelineStore : public DeviceTest {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override {
    fs::remove_all(folder_);
    DeviceTest::TearDown();
  }

  // Whether pipelines were at hand. Builds on a device of its own, and fails on another tree than the one
  // without a folder.
  static bool build_with(const fs::path& folder) {
    Device device({"", true, false, folder});
    const std::vector<Triangle> triangles = random_triangles(700, 1);
    EXPECT_EQ(tree_hash(build_on(device, triangles, {}).nodes),
              tree_hash(build_on(test_device(), triangles, {}).nodes));
    for (const std::string& message : device.take_validation_messages()) ADD_FAILURE() << message;
    return device.has_kept_pipelines();
  }

  fs::path only_file() const {
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(folder_)) files.push_back(file.path());
    EXPECT_EQ(files.size(), 1u);
    return files.at(0);
  }

  const fs::path folder_ = fs::temp_directory_path() / ("coppice_pipelines_" + std::to_string(getpid()));
};

std::string read(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

constexpr std::size_t blob_begin = 24;  // behind magic, size and hash

// The file with one byte of the driver's blob changed, and the hash made to fit.
std::string with_other_byte(std::string file, std::size_t at) {
  file[blob_begin + at] = static_cast<char>(file[blob_begin + at] ^ 1);
  std::uint64_t hash = 14695981039346656037u;
  for (std::size_t i = blob_begin; i < file.size(); ++i)
    hash = (hash ^ static_cast<std::uint8_t>(file[i])) * 1099511628211u;
  std::memcpy(file.data() + 16, &hash, sizeof hash);
  return file;
}

TEST_F(PipelineStore, TheSecondRunFindsWhatTheFirstKept) {
  EXPECT_FALSE(build_with(folder_ / "made" / "when" / "needed"));
  EXPECT_TRUE(build_with(folder_ / "made" / "when" / "needed"));
}

TEST_F(PipelineStore, CorruptAndForeignFilesAreReplaced) {
  EXPECT_FALSE(build_with(folder_));
  const fs::path file = only_file();
  const std::string good = read(file);
  ASSERT_GT(good.size(), blob_begin + 31);
  std::string altered = good;
  altered.back() = static_cast<char>(altered.back() ^ 1);
  const std::string other_vendor = with_other_byte(good, 8), other_driver = with_other_byte(good, 20);
  for (const std::string& bad : {std::string(), std::string("nonsense"), good.substr(0, good.size() - 1),
                                 good + "x", altered, other_vendor, other_driver}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bad;
    EXPECT_FALSE(build_with(folder_)) << bad.size() << " bytes";
    EXPECT_EQ(read(only_file()).size(), good.size());
    EXPECT_TRUE(build_with(folder_)) << bad.size() << " bytes";
  }
}

TEST_F(PipelineStore, AFolderThatCannotBeIsNoError) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "no folder";
  EXPECT_FALSE(build_with(folder_ / "file"));
  EXPECT_FALSE(build_with(folder_ / "file" / "below"));
  EXPECT_EQ(read(only_file()), "no folder");
}

TEST_F(PipelineStore, NothingIsKeptWithoutAFolder) { EXPECT_FALSE(build_with({})); }

}  // namespace
}  // namespace coppice
