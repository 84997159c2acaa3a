#include "app/study/scanner_choice.h"

#include <gtest/gtest.h>

namespace patrol::app {
namespace {

const ScannedWorld& substation() { return scanned_worlds().at(1); }

/// Settings for a fraction of the time: 2 s instead of 1 min.
constexpr ScannerChoiceSettings kCoarse = {.pose_spacing_m = 12.0, .grid_m = 6.0, .num_restarts = 2};

TEST(ScannerChoice, PositionsOfTheSubstationSeeMoreThanThoseChosenByHand) {
  const std::vector<Eigen::Vector2d> by_hand = {{8.0, 8.0},    {40.0, 8.0},  {75.0, 8.0},  {111.0, 9.0},
                                                {112.0, 45.0}, {86.0, 34.0}, {59.0, 40.0}, {32.0, 55.5},
                                                {85.0, 56.0},  {8.0, 60.0},  {35.0, 82.0}, {90.0, 82.0}};
  const ScannerChoice choice(substation(), kCoarse);
  EXPECT_GT(choice.value_of(substation().scanners_m), choice.value_of(by_hand) + 0.02);
}

TEST(ScannerChoice, RestartsAndMorePositionsIncreaseTheValue) {
  ScannerChoiceSettings settings = kCoarse;
  const ScannerChoice choice(substation(), settings);
  settings.num_restarts = 0;
  const ScannerChoice once(substation(), settings);
  const double value = choice.value_of(choice.choose(12));
  EXPECT_GE(value, choice.value_of(once.choose(12)));
  EXPECT_GT(value, choice.value_of(choice.choose(6)) + 0.05);
}

TEST(ScannerChoice, PositionsAreOnTheRoadsAndAwayFromTheTruck) {
  for (const Eigen::Vector2d& p : ScannerChoice(substation(), kCoarse).choose(12)) {
    const bool is_at_truck = std::abs(p.x() - substation().truck_m.x()) < 5.0 && std::abs(p.y() - 7.0) < 2.5;
    EXPECT_FALSE(is_at_truck) << p.transpose();
    EXPECT_TRUE(p.x() > 5.0 && p.x() < 115.0 && p.y() > 5.0 && p.y() < 85.0) << p.transpose();
  }
}

/// The search for the stored positions. It takes 1 min.
TEST(ScannerChoice, DISABLED_StoredPositionsHaveTheValueOfTheSearch) {
  const ScannerChoice choice(substation(), {});
  const std::vector<Eigen::Vector2d> chosen = choice.choose(12);
  for (const Eigen::Vector2d& p : chosen) GTEST_LOG_(INFO) << p.transpose();
  GTEST_LOG_(INFO) << choice.value_of(chosen) << ", stored " << choice.value_of(substation().scanners_m);
  EXPECT_GE(choice.value_of(substation().scanners_m), choice.value_of(chosen) - 0.005);
}

}  // namespace
}  // namespace patrol::app
