#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace patrol::slam {

/// Indices of the nearest entries, at most `limit`, nearest first; the input holds (distance, index) pairs.
inline std::vector<int> nearest(std::vector<std::pair<double, int>> by_distance, int limit) {
  std::sort(by_distance.begin(), by_distance.end());
  if (by_distance.size() > static_cast<std::size_t>(limit)) by_distance.resize(static_cast<std::size_t>(limit));
  std::vector<int> chosen;
  for (const auto& [distance_m, index] : by_distance) chosen.push_back(index);
  return chosen;
}

}  // namespace patrol::slam
