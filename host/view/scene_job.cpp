#include "view/scene_job.h"

#include <exception>
#include <mutex>

#include "pipeline/loose_thread.h"

namespace coppice {

struct SceneJob::Work {
  std::mutex mutex;
  bool done = false;
  Result result;
};

void SceneJob::start(const SceneOptions& scene, const BuilderChoice& builder) {
  what_ = builder.on_device() ? "opening " + scene.spec
                              : "opening " + scene.spec + ", building by " + builder.name;
  work_ = std::make_shared<Work>();
  start_loose_thread([work = work_, scene, builder] {
    Result result;
    try {
      result.opened = std::make_unique<OpenedScene>(open_for_view(scene, builder));
    } catch (const std::bad_alloc&) {
      result.complaint = scene.spec + ": out of memory";
    } catch (const std::exception& error) {
      result.complaint = error.what();
    }
    const std::lock_guard lock(work->mutex);
    work->result = std::move(result);
    work->done = true;
  });
}

SceneJob::Result SceneJob::take() {
  if (!work_) return {};
  Result result;
  {
    const std::lock_guard lock(work_->mutex);
    if (!work_->done) return {};
    result = std::move(work_->result);
  }
  work_ = nullptr;
  return result;
}

}  // namespace coppice
