#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace patrol {

/// Returns the median, of an even number of values the larger one of the two in the middle. `values` must not be empty.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace patrol
