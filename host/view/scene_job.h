#pragma once

#include <memory>
#include <string>

#include "view/opened_scene.h"

namespace coppice {

// Opens scenes, and builds trees on the host, beside the window. One at a time: a later one replaces an
// earlier one, whose result is dropped when it comes.
class SceneJob {
 public:
  SceneJob() = default;
  SceneJob(const SceneJob&) = delete;

  // Where one is under way at the end, its loose thread goes on with what is its own.
  ~SceneJob() = default;

  void start(const SceneOptions& scene, const BuilderChoice& builder);
  bool is_under_way() const { return work_ != nullptr; }
  const std::string& what() const { return what_; }

  struct Result {
    std::unique_ptr<OpenedScene> opened;  // null: not yet
    std::string complaint;                // in place of a scene
  };
  // What has come, once; nothing as long as it is under way.
  Result take();

 private:
  struct Work;
  std::shared_ptr<Work> work_;
  std::string what_;
};

}  // namespace coppice
