#include "localize/line_of_sight_monitor.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::localize::line_of_sight_monitor_test {
namespace {

constexpr int kRanges = 4000;
constexpr double kPeriod_s = 0.5, kNoise_m = 0.1;

/// Share of the ranges in line of sight. `error_m`: error of a range besides its noise, by its index.
double accepted_ratio(LineOfSightMonitor& monitor, const std::function<double(std::uint64_t)>& error_m) {
  const RandomStream noise(1, "line_of_sight_test/noise");
  int accepted = 0;
  for (std::uint64_t i = 0; i < kRanges; ++i) {
    const Time stamp = from_seconds(kPeriod_s * static_cast<double>(i));
    accepted += monitor.add(1, stamp, error_m(i) + kNoise_m * noise.normal(i, 0)) ? 1 : 0;
  }
  return static_cast<double>(accepted) / kRanges;
}

double excess_m(std::uint64_t i) {
  static const RandomStream excess(1, "line_of_sight_test/excess");
  return -0.4 * std::log(excess.uniform(i, 0));
}

TEST(LineOfSightMonitor, AcceptsAtLeast95PercentOfRangesInLineOfSightWithADelayOf30Cm) {
  LineOfSightMonitor monitor({});
  EXPECT_GT(accepted_ratio(monitor, [](std::uint64_t) { return 0.3; }), 0.95);
}

TEST(LineOfSightMonitor, RejectsAtLeast95PercentOfRangesWithAnExponentialExcessOf40Cm) {
  LineOfSightMonitor monitor({});
  EXPECT_LT(accepted_ratio(monitor, excess_m), 0.05);
}

TEST(LineOfSightMonitor, AcceptsRangesAgainAtMostTheLengthOfTheWindowAfterAnObstacle) {
  LineOfSightMonitor monitor({});
  const RandomStream noise(2, "line_of_sight_test/noise");
  int rejected_after = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const double error_m = (i < 30 ? 0.2 + excess_m(i) : 0.0) + kNoise_m * noise.normal(i, 0);
    const bool is_accepted = monitor.add(1, from_seconds(kPeriod_s * static_cast<double>(i)), error_m);
    if (i >= 30 && !is_accepted) ++rejected_after;
  }
  EXPECT_GE(rejected_after, 1);
  EXPECT_LE(rejected_after, 16);
}

TEST(LineOfSightMonitor, ComparesRangesOfOneAnchorAndOfTheLast10SecondsOnly) {
  LineOfSightMonitor monitor({});
  for (int i = 0; i < 8; ++i) {
    monitor.add(1, from_seconds(0.5 * i), 0.0);
    monitor.add(2, from_seconds(0.5 * i), 2.0);
  }
  EXPECT_TRUE(monitor.add(1, from_seconds(4.0), 0.0));
  EXPECT_TRUE(monitor.add(2, from_seconds(4.0), 2.0));
  EXPECT_FALSE(monitor.add(2, from_seconds(4.5), 0.0)) << "differs from the ranges before it by 2 m";
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(monitor.add(1, from_seconds(20.0 + i), 1.0)) << "too few to be compared";
  EXPECT_TRUE(monitor.add(1, from_seconds(25.0), 1.0));
}

TEST(LineOfSightMonitor, RefusesSettingsOutOfRange) {
  EXPECT_THROW(LineOfSightMonitor({.min_ranges = 1}), InputError);
  EXPECT_THROW(LineOfSightMonitor({.max_std_ratio = 0.5}), InputError);
  EXPECT_THROW(LineOfSightMonitor({.window_ranges = 5, .min_ranges = 6}), InputError);
}

}  // namespace
}  // namespace patrol::localize::line_of_sight_monitor_test
