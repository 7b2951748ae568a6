#include "stages/cpu_executor.h"

namespace coppice {

CpuExecutor::CpuExecutor(const Layout& layout) {
  for (const std::uint64_t bytes : layout.block_bytes()) {
    blocks_.push_back(std::make_unique<std::uint64_t[]>((bytes + 7) / 8));
    addresses_.push_back(reinterpret_cast<std::uint64_t>(blocks_.back().get()));
  }
}

bool CpuExecutor::does_nothing(const Step& step) const {
  if (std::holds_alternative<Mark>(step)) return true;
  const Dispatch* const dispatch = dispatch_of(step);
  if (!dispatch || !dispatch->indirect) return false;
  std::uint32_t groups_x;
  std::memcpy(&groups_x, at(*dispatch->indirect), sizeof groups_x);
  return groups_x == 0;
}

void CpuExecutor::run(const Step& step) {
  if (does_nothing(step)) return;
  if (const Clear* const clear = std::get_if<Clear>(&step)) {
    std::memset(at(clear->place), 0, clear->bytes);
  } else {
    const Dispatch& dispatch = std::get<Dispatch>(step);
    dispatch.stage->twin(dispatch.args.data());
  }
}

}  // namespace coppice
