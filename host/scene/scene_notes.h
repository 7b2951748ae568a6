#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace coppice {

// Gathers what is odd about a file and not fatal into one line a kind: the first place, and how many more.
class SceneNotes {
 public:
  explicit SceneNotes(std::string name) : name_(std::move(name)) {}

  // `what` is printable and the same for all notes of a kind.
  void add(const std::string& place, const std::string& what);
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string what, first_place;
    std::size_t count;
  };
  std::string name_;
  std::vector<Entry> entries_;
};

}  // namespace coppice
