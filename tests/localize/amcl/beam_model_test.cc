#include "localize/amcl/beam_model.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::localize::amcl_beam_model_test {
namespace {

constexpr double kNoEcho = std::numeric_limits<double>::infinity();

/// A closed room, 10 m by 6 m, of 5 cm cells, its walls one cell thick.
OccupancyGrid make_room() {
  OccupancyGrid map({.resolution_m = 0.05, .width = 200, .height = 120}, kFree);
  for (int col = 0; col < 200; ++col) map.at({col, 0}) = map.at({col, 119}) = kOccupied;
  for (int row = 0; row < 120; ++row) map.at({0, row}) = map.at({199, row}) = kOccupied;
  return map;
}

// The hit's part is scaled by what of it lies in range, so the density over the ranges and the share of no echo are
// all.
TEST(BeamModel, IsAProbabilityOverRangesAndNoEcho) {
  const BeamModelSettings settings;
  for (const double expected_m : {0.5, 4.0, 29.9}) {
    constexpr double kStep = 1e-3;
    double sum = 0.0;
    for (double range_m = 0.5 * kStep; range_m < settings.max_range_m; range_m += kStep)
      sum += kStep * std::exp(beam_log_likelihood(range_m, expected_m, settings));
    const double no_echo = settings.z_max / (settings.z_hit + settings.z_short + settings.z_max + settings.z_rand);
    EXPECT_NEAR(sum + no_echo, 1.0, 1e-3) << expected_m;
  }
}

// 0.75 / (0.1 sqrt(2 pi)) + 0.1 * 0.2 exp(-0.8) / (1 - exp(-0.8)) + 0.05 / 30 at 4 m.
TEST(BeamModel, AtTheExpectedRangeIsTableSixPointOne) {
  const double hit = 0.75 / (0.1 * std::sqrt(2.0 * std::numbers::pi));
  const double in_front = 0.1 * 0.2 * std::exp(-0.8) / (1.0 - std::exp(-0.8));
  EXPECT_NEAR(beam_log_likelihood(4.0, 4.0, {}), std::log(hit + in_front + 0.05 / 30.0), 1e-9);
}

TEST(BeamModel, AShortRangeIsLikelierThanALongOne) {
  EXPECT_GT(beam_log_likelihood(2.0, 4.0, {}), beam_log_likelihood(6.0, 4.0, {}) + 1.0);
}

TEST(BeamModel, NoEchoIsLikeliestWhereThereIsNothingToHit) {
  EXPECT_GT(beam_log_likelihood(kNoEcho, 30.0, {}), beam_log_likelihood(kNoEcho, 4.0, {}) + 1.0);
}

TEST(BeamModel, RaysEndWithinACellOfTheWall) {
  const BeamModel model({}, make_room());
  const Eigen::Vector2d origin(3.0, 2.0);
  for (int i = 0; i < 90; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 90.0, c = std::cos(angle), s = std::sin(angle);
    const double to_x = c > 0.0 ? (9.95 - 3.0) / c : (0.05 - 3.0) / c,
                 to_y = s > 0.0 ? (5.95 - 2.0) / s : (0.05 - 2.0) / s;
    const double true_m = std::min(c != 0.0 ? to_x : kNoEcho, s != 0.0 ? to_y : kNoEcho);
    EXPECT_NEAR(model.expected_range_m(origin, angle), true_m, 0.05) << angle;
  }
}

TEST(BeamModel, RaysThatLeaveTheMapMeetNothing) {
  OccupancyGrid map({.resolution_m = 0.05, .width = 20, .height = 20}, kFree);
  EXPECT_EQ(BeamModel({}, map).expected_range_m({0.5, 0.5}, 1.0), 30.0);
}

TEST(BeamModel, ThePoseThatTheScanWasTakenFromFitsBest) {
  const BeamModel model({}, make_room());
  LevelScan scan;
  for (int i = 0; i < 60; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 60.0;
    const double range_m = model.expected_range_m({3.0, 2.0}, angle);
    scan.beams.push_back({(range_m * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>(), true});
  }
  const ScanLikelihoods fits =
      model.evaluate(scan, {{3.0, 2.0, 0.0}, {3.2, 2.0, 0.0}, {3.0, 2.2, 0.0}, {3.0, 2.0, 0.1}});
  EXPECT_GT(fits.mean_log[0], -0.1);
  for (const std::size_t other : {1U, 2U, 3U}) EXPECT_LT(fits.mean_log[other], fits.mean_log[0] - 0.3);
}

// A beam of 6 m that is free, but leaves the height band there, is consistent with the wall 7 m ahead.
TEST(BeamModel, BeamsThatEndFreeBeforeTheMaximumRangeAreNotUsed) {
  const BeamModel model({}, make_room());
  const auto add_beam = [](LevelScan& scan, double range_m, bool is_hit) {
    scan.beams.push_back({Eigen::Vector2d(range_m, 0.0).cast<float>(), is_hit});
  };
  const std::vector<Pose2> poses = {{3.0, 2.0, 0.0}, {3.2, 2.0, 0.0}};
  LevelScan hit, with_free;
  for (int i = 0; i < 3; ++i) {
    add_beam(hit, 6.95, true);
    add_beam(with_free, 6.95, true);
    add_beam(with_free, 6.0, false);
  }
  const ScanLikelihoods expected = model.evaluate(hit, poses), actual = model.evaluate(with_free, poses);
  EXPECT_EQ(actual.num_beams, 3);
  EXPECT_EQ(actual.mean_log, expected.mean_log);
}

// The room is 10 m long: beyond 8 m it has no surface for a beam of at most 5 m.
TEST(BeamModel, AHitBeyondTheMaximumRangeCountsAsNoReturn) {
  BeamModelSettings settings;
  settings.max_range_m = 5.0;
  const BeamModel model(settings, make_room());
  LevelScan hit, nothing;
  hit.beams.push_back({{6.95F, 0.0F}, true});
  nothing.beams.push_back({{6.95F, 0.0F}, false});
  for (const double x : {3.0, 8.0}) {
    const double by_hit = model.evaluate(hit, {{x, 2.0, 0.0}}).mean_log[0];
    EXPECT_EQ(by_hit, model.evaluate(nothing, {{x, 2.0, 0.0}}).mean_log[0]);
    EXPECT_EQ(by_hit, beam_log_likelihood(kNoEcho, x == 3.0 ? 5.0 : 1.95, settings));
  }
}

}  // namespace
}  // namespace patrol::localize::amcl_beam_model_test
