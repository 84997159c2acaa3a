#pragma once

#include <limits>
#include <map>
#include <string>

namespace patrol::io {

/// What a metric must be: `true`, `false`, a number, or a band {min:, max:}.
struct Expectation {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool is_boolean = false;
};

/// By the metric's path in metrics.json, e.g. "pose.ate_rmse_m".
using Expectations = std::map<std::string, Expectation>;

}  // namespace patrol::io
