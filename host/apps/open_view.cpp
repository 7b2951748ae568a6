#include "apps/open_view.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gpu/device.h"
#include "scene/input_error.h"

namespace coppice {

// With the arguments of this one, which have been found good.
ViewReport open_view(const ViewRun&, const Note&) {
  if (list_devices().empty()) Device();  // says why there are none
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string window = (program.parent_path() / "coppice-view").string();
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  const std::string words = text.str();
  std::vector<std::string> given;
  for (std::size_t begin = 0; begin < words.size(); begin += given.back().size() + 1)
    given.emplace_back(words.c_str() + begin);
  std::vector<char*> arguments;
  for (std::string& word : given) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(window.c_str(), arguments.data());
  if (errno != ENOENT) throw InputError(window + ": cannot be started: " + std::strerror(errno));
  throw InputError(
      "this build has no window: install the Debian packages libglfw3-dev and libimgui-dev and build again");
}

}  // namespace coppice
