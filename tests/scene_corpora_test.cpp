// Every glTF, scene and PLY file that the fuzzers keep, and every one that once was a bug, is read as it
// should be.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/scene_inputs.h"

namespace coppice {
namespace {

void expect_no_complaint(const std::string& corpus, std::string (*complaint)(std::string_view)) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(COPPICE_FUZZ_FOLDER "/" + corpus)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(input.empty()) << entry.path();
    EXPECT_EQ(complaint(input), "") << entry.path();
    ++count;
  }
  EXPECT_GE(count, 5u) << corpus;
}

TEST(SceneCorpora, Gltf) { expect_no_complaint("corpus_gltf", complaint_about_gltf); }
TEST(SceneCorpora, SceneFiles) { expect_no_complaint("corpus_scene_file", complaint_about_scene_file); }
TEST(SceneCorpora, Ply) { expect_no_complaint("corpus_ply", complaint_about_ply); }

}  // namespace
}  // namespace coppice
