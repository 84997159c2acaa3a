#pragma once

#include <limits>
#include <map>
#include <string>

namespace patrol::io {

/// Expected value of a metric: `true`, `false`, a number, or an interval {min:, max:}.
struct Expectation {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool is_boolean = false;
};

/// Expected values by the path of the metric in metrics.json, e.g. "pose.ate_rmse_m".
using Expectations = std::map<std::string, Expectation>;

}  // namespace patrol::io
