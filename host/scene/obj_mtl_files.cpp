#include "scene/obj_mtl_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "scene/obj_lines.h"

namespace coppice {

std::optional<FoundMtl> MtlFolder::find(const std::string& name, MtlMatch match) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  if (name.empty() || name.find('\0') != name.npos) return std::nullopt;
  if (match == MtlMatch::AS_WRITTEN) {
    std::optional<FoundMtl> found = read(name);
    return found || slashes == name ? found : read(slashes);
  }
  const std::filesystem::path path = slashes;
  for (const auto& tried : {path, path.filename()}) {
    if (tried.empty()) continue;
    if (std::optional<FoundMtl> found = read(tried)) return found;
    if (const auto other = find_in_any_case(tried)) {
      if (std::optional<FoundMtl> found = read(*other)) return found;
    }
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> MtlFolder::locate(const std::string& name) {
  if (name.empty() || name.find('\0') != name.npos) return std::nullopt;
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const std::filesystem::path path = slashes;
  for (const std::filesystem::path& tried : {std::filesystem::path(name), path, path.filename()}) {
    std::error_code error;
    if (!tried.empty() && std::filesystem::is_regular_file(folder_ / tried, error)) return folder_ / tried;
  }
  for (const std::filesystem::path& tried : {path, path.filename()}) {
    if (const auto other = find_in_any_case(tried)) return folder_ / *other;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> MtlFolder::find_in_any_case(const std::filesystem::path& relative) {
  std::vector<std::filesystem::path> found = {{}};  // all that the steps so far may mean
  for (const std::filesystem::path& step : relative) {
    std::vector<std::filesystem::path> next;
    // Of paths to one place, such as x/.. and X/.., the first is kept: else each step could double their
    // number.
    std::set<std::filesystem::path> places;
    const auto add = [&](const std::filesystem::path& path) {
      std::error_code error;
      const std::filesystem::path place = std::filesystem::canonical(folder_ / path, error);
      if (!error && places.insert(place).second) next.push_back(path);
    };
    const std::string lower = lower_case(step.string());
    for (const std::filesystem::path& folder : found) {
      add(folder / step);
      for (const std::filesystem::path& name : list(folder_ / folder)) {
        if (name != step && lower_case(name.string()) == lower) add(folder / name);
      }
    }
    found = std::move(next);
  }
  const auto is_file = [&](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(folder_ / path, error);
  };
  const auto file = std::find_if(found.begin(), found.end(), is_file);
  return file == found.end() ? std::nullopt : std::optional(*file);
}

const std::vector<std::filesystem::path>& MtlFolder::list(const std::filesystem::path& folder) {
  const auto [entry, is_new] = listings_.try_emplace(folder);
  if (is_new) {
    std::error_code error;
    std::filesystem::directory_iterator at(folder.empty() ? "." : folder, error);
    for (; !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
      entry->second.push_back(at->path().filename());
    }
    std::sort(entry->second.begin(), entry->second.end());
  }
  return entry->second;
}

std::optional<FoundMtl> MtlFolder::read(const std::filesystem::path& relative) const {
  const std::filesystem::path path = folder_ / relative;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  if (std::filesystem::file_size(path, error) > MAX_MTL_BYTES || error) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(file), {}};
  return FoundMtl{relative.lexically_normal().string(), std::move(text)};
}

}  // namespace coppice
