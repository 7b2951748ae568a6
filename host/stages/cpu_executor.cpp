#include "stages/cpu_executor.h"

namespace coppice {

CpuExecutor::CpuExecutor(const Layout& layout) {
  for (const std::uint64_t bytes : layout.block_bytes()) {
    blocks_.push_back(std::make_unique<std::uint64_t[]>((bytes + 7) / 8));
  }
}

Chain CpuExecutor::chain() const {
  std::vector<std::uint64_t> addresses;
  for (const auto& block : blocks_) addresses.push_back(reinterpret_cast<std::uint64_t>(block.get()));
  return Chain(std::move(addresses));
}

void CpuExecutor::run(const Step& step) {
  if (!step.stage) {
    std::memset(at(step.place), 0, step.clear_bytes);
    return;
  }
  if (step.indirect) {
    std::uint32_t groups_x;
    std::memcpy(&groups_x, at(step.place), sizeof groups_x);
    if (groups_x == 0) return;
  }
  step.stage->twin(step.args.data());
}

}  // namespace coppice
