#pragma once

#include <string>

#include "io/json/metrics_json.h"
#include "score/pose/relation_error.h"

namespace patrol::app {

/// Table of the benchmark's metrics for a terminal, with the digits in which they are published.
std::string relation_table(const score::RelationError& error);

/// The benchmark's metrics for `--json`.
io::Metrics relation_json(const score::RelationError& error);

}  // namespace patrol::app
