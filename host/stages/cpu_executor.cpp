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

bool CpuExecutor::does_nothing(const Step& step) const {
  if (!step.stage) return step.clear_bytes == 0;
  if (!step.indirect) return false;
  std::uint32_t groups_x;
  std::memcpy(&groups_x, at(step.place), sizeof groups_x);
  return groups_x == 0;
}

void CpuExecutor::run(const Step& step) {
  if (does_nothing(step)) return;
  if (step.stage) {
    step.stage->twin(step.args.data());
  } else {
    std::memset(at(step.place), 0, step.clear_bytes);
  }
}

}  // namespace coppice
