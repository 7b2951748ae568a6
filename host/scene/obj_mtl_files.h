#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace coppice {

// An MTL file that a name led to.
struct FoundMtl {
  std::string name;  // of the file as it was found, relative to the OBJ's folder; the same for the same file
  std::string text;
};

// How near a file's name must be to what an OBJ says.
enum class MtlMatch {
  AS_WRITTEN,  // with \ for / allowed
  NEAR,        // other letter case; the bare file name, beside the OBJ
};

// Finds an MTL file by a name in the OBJ.
using FindMtl = std::function<std::optional<FoundMtl>(const std::string& name, MtlMatch match)>;

// Finds MTL files from the folder of an OBJ. Only regular files up to MAX_MTL_BYTES are read.
class MtlFolder {
 public:
  explicit MtlFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::optional<FoundMtl> find(const std::string& name, MtlMatch match);

  // The path of a regular file of any kind and size, as written, else near.
  std::optional<std::filesystem::path> locate(const std::string& name);

 private:
  std::optional<std::filesystem::path> find_in_any_case(const std::filesystem::path& relative);
  const std::vector<std::filesystem::path>& list(const std::filesystem::path& folder);
  std::optional<FoundMtl> read(const std::filesystem::path& relative) const;

  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::vector<std::filesystem::path>> listings_;  // names, sorted
};

inline constexpr std::uintmax_t MAX_MTL_BYTES = std::uintmax_t{256} << 20;

}  // namespace coppice
