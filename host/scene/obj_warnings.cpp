#include "scene/obj_warnings.h"

namespace coppice {

void ObjWarnings::add(ObjWarning kind, const std::string& place, const std::string& what, std::size_t count) {
  if (count == 0) return;
  Entry& entry = entries_[kind];
  if (entry.count == 0) entry.first = place + ": " + what;
  entry.count += count;
}

std::vector<std::string> ObjWarnings::lines() const {
  std::vector<std::string> lines;
  for (const auto& [kind, entry] : entries_) {
    lines.push_back(entry.first);
    if (entry.count > 1) lines.back() += "; " + std::to_string(entry.count) + " such in all";
  }
  return lines;
}

}  // namespace coppice
