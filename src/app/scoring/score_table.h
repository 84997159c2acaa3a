#pragma once

#include <string>
#include <vector>

#include "app/scoring/expectations.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// The metrics as a table for a terminal, beside what the scenario expects of them: one line each, groups apart.
std::string score_table(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks);

}  // namespace patrol::app
