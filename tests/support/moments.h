#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::test {

/// Mean, spread and extremes of a stream of numbers.
struct Moments {
  double sum = 0.0, squares = 0.0;
  double smallest = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    ++count;
  }
  double mean() const { return count == 0 ? 0.0 : sum / count; }
  double rms() const { return count == 0 ? 0.0 : std::sqrt(squares / count); }
  double std() const { return std::sqrt(std::max(0.0, rms() * rms() - mean() * mean())); }
};

}  // namespace patrol::test
