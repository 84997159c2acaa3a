#pragma once

#include <string>

#include "io/json/metrics_json.h"

namespace patrol::app {

/// Table of the mission's goal errors compared with [Liu21, table 2], with the number of goals not reached; empty
/// without navigation goals.
std::string goal_table(const io::Metrics& metrics);

}  // namespace patrol::app
