#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "report/blocks.h"
#include "report/quantity.h"
#include "score/statistics.h"

namespace patrol::report {

/// Box of a box plot: values of one metric in its display unit, quartiles, and the median as text; only the label
/// without values.
inline Box box_of(const std::string& label, std::vector<double> values, const Unit& unit) {
  Box box{.label = label, .values = std::move(values), .text = ""};
  if (box.values.empty()) return box;
  for (double& value : box.values) value *= unit.factor;
  box.lower_quartile = score::percentile(box.values, 0.25);
  box.median = score::percentile(box.values, 0.5);
  box.upper_quartile = score::percentile(box.values, 0.75);
  box.text = fmt::format("{:.3g} {}", box.median, unit.name);
  return box;
}

}  // namespace patrol::report
