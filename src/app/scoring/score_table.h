#pragma once

#include <string>
#include <vector>

#include "app/common/text_style.h"
#include "app/scoring/expectations.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Table of the metrics for a terminal, with the scenario's expectations: one line per metric, groups separated.
std::string score_table(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks,
                        TextStyle style = TextStyle::kPlain);

}  // namespace patrol::app
