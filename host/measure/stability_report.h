#pragma once

#include <string>

#include "measure/json.h"
#include "measure/stability_runs.h"
#include "measure/table.h"

namespace coppice {

// What the command stability says.
Json to_json(const StabilityCase& result);
Table table_of(std::span<const StabilityCase> cases);
Table table_of(const KindSums& kinds);
Table table_of(std::span<const LeakCount> leaks);

}  // namespace coppice
