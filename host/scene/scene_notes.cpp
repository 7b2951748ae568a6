#include "scene/scene_notes.h"

#include <algorithm>

namespace coppice {

void SceneNotes::add(const std::string& place, const std::string& what) {
  const auto known =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.what == what; });
  if (known == entries_.end()) {
    entries_.push_back({what, place, 1});
  } else {
    ++known->count;
  }
}

std::vector<std::string> SceneNotes::lines() const {
  std::vector<std::string> lines;
  for (const auto& [what, place, count] : entries_) {
    lines.push_back(name_ + ": " + (place.empty() ? "" : place + ": ") + what);
    if (count > 1) lines.back() += " (and " + std::to_string(count - 1) + " more)";
  }
  return lines;
}

}  // namespace coppice
