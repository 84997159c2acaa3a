#pragma once

#include <string>

#include "io/metrics_json.h"

namespace patrol::app {

/// A tour's goals beside paper 004's table 2, and how often each was not reached; empty when the metrics hold no goal that was driven to.
std::string goal_table(const io::Metrics& metrics);

}  // namespace patrol::app
