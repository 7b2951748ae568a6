#include "stages/stages.h"

#include "kernels_spirv.h"

namespace coppice {

#define COPPICE_DEFINE_STAGE(stem, Args, Constants, nearly)                                        \
  const Stage<Args, Constants> stages::stem{                                                       \
      {#stem, spirv::stem, [](const void* args) { twins::stem(*static_cast<const Args*>(args)); }, \
       [](const void* args, const RunCounts& counts) {                                             \
         return traffic::stem(*static_cast<const Args*>(args), counts);                            \
       },                                                                                          \
       nearly, address_args_of<Args>}};                                                            \
  static_assert(sizeof(Args) <= 128 && sizeof(Args) % 8 == 0, "push constants of " #stem);
COPPICE_STAGES(COPPICE_DEFINE_STAGE)
#undef COPPICE_DEFINE_STAGE

std::span<const StageDeclaration* const> all_stages() {
#define COPPICE_LIST_STAGE(stem, Args, Constants, nearly) &stages::stem,
  static constexpr const StageDeclaration* list[] = {COPPICE_STAGES(COPPICE_LIST_STAGE)};
#undef COPPICE_LIST_STAGE
  return list;
}

}  // namespace coppice
