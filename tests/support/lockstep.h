#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stages/lockstep_executor.h"
#include "support/test_device.h"

namespace coppice {

// Spoils the steps of a build before they run.
using Plant = std::function<void(std::vector<Step>&)>;

// Builds by every kernel and its twin on the test device; the first difference, if any.
std::optional<Difference> build_in_lockstep(std::span<const Triangle> triangles, const BuildOptions& options,
                                            const Plant& plant = {});

// Fails, and shows where, if there is one.
void expect_build_in_lockstep(std::span<const Triangle> triangles, const BuildOptions& options,
                              const std::string& what);

std::vector<std::string_view> hard_case_names();

}  // namespace coppice
