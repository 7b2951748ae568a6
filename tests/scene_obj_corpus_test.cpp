// Every input that the fuzzer keeps, and every one that once was a bug, is read as it should be.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/obj_input.h"

namespace coppice {
namespace {

TEST(ObjCorpus, NothingToComplainOf) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(COPPICE_OBJ_CORPUS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(input.empty()) << entry.path();
    EXPECT_EQ(complaint_about_obj(input), "") << entry.path();
    ++count;
  }
  EXPECT_GE(count, 20u) << COPPICE_OBJ_CORPUS;
}

}  // namespace
}  // namespace coppice
