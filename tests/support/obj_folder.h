#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/input_error.h"
#include "scene/load_obj.h"

namespace coppice {

inline const std::string TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// Every test writes its files into a folder of its own.
class ObjFolder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("coppice_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene load(const std::string& text) const { return load_obj(write("scene.obj", text)); }

  // The warnings without the folder.
  std::vector<std::string> warnings_of(const Scene& scene) const {
    std::vector<std::string> warnings = scene.warnings;
    for (std::string& warning : warnings) {
      const std::string prefix = (folder_ / "").string();
      if (warning.starts_with(prefix)) warning.erase(0, prefix.size());
    }
    return warnings;
  }

  // The name of each triangle's material.
  static std::vector<std::string> names_of(const Scene& scene) {
    std::vector<std::string> names;
    for (const std::uint32_t index : scene.material_index) names.push_back(scene.materials[index].name);
    return names;
  }

  // The message of the error, from the file's name on; empty if there is no error.
  std::string error_of(const std::filesystem::path& path) const {
    try {
      load_obj(path);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << "more than one line";
      EXPECT_TRUE(what.starts_with(path.string())) << "does not name the file: " << what;
      return path.filename().string() + what.substr(path.string().size());
    }
    return "";
  }
  std::string error_in(const std::string& text) const { return error_of(write("bad.obj", text)); }

  std::filesystem::path folder_;
};

}  // namespace coppice
