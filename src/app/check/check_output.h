#pragma once

#include <string>

#include "app/check/run_check.h"
#include "app/common/text_style.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Returns the sentence of the verdict: "All 8 maneuvers passed." or "2 of 8 maneuvers failed: ramp, steps."
std::string verdict_text(const CheckResult& result);

/// Table for the terminal: one line per maneuver with its key figures, and one line per failure.
std::string check_table(const CheckResult& result, TextStyle style);

/// Contents of check.json: robot, verdict, and per maneuver the figures, their limits and the failures.
io::Metrics check_json(const CheckResult& result);

}  // namespace patrol::app
