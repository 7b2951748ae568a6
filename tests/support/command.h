#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace coppice {

namespace fs = std::filesystem;

struct Outcome {
  int status;
  std::string out, err;
};

// Runs the program in a folder of its own, which holds a triangle, one.obj.
class Command : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("coppice_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    fs::current_path(folder_);
    write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  void TearDown() override {
    fs::current_path(fs::temp_directory_path());
    fs::remove_all(folder_);
  }

  static void write(const std::string& name, const std::string& text) {
    std::ofstream(name, std::ios::binary) << text;
  }

  static std::string read(const std::string& name) {
    std::stringstream text;
    text << std::ifstream(name).rdbuf();
    return text.str();
  }

  static Outcome run(const std::string& arguments) { return run_with("", arguments); }

  // In an address space of so many kilobytes.
  static Outcome run_in(std::uint64_t kilobytes, const std::string& arguments) {
    return run_with("ulimit -v " + std::to_string(kilobytes) + "; ", arguments);
  }

  static Outcome run_with(const std::string& before, const std::string& arguments) {
    const std::string command =
        before + "timeout 120 " + COPPICE_PROGRAM + " " + arguments + " >stdout.txt 2>stderr.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("stdout.txt"), read("stderr.txt")};
  }

  // Of stderr, without what is said of the driver and the machine, which is not the same everywhere.
  static std::string without_notes(const std::string& text) {
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("note: ")) kept += line + '\n';
    }
    return kept;
  }

  // Exit status, one line on stderr that holds `part`, and no picture.
  static void expect_refused(const std::string& arguments, int status, const std::string& part) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << arguments << ": " << outcome.err;
    EXPECT_EQ(std::ranges::count(without_notes(outcome.err), '\n'), 1) << arguments << ": " << outcome.err;
    EXPECT_FALSE(fs::exists("out.png")) << arguments;
  }

  fs::path folder_;
};

}  // namespace coppice
