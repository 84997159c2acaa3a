#include "localize/range_filter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/error.h"
#include "localize/track_odometry.h"
#include "tests/support/tracked_drive.h"
#include "tests/support/uwb_tunnel.h"

namespace patrol::localize::range_filter_test {
namespace {

using test::make_tracked_robot;
using test::make_tunnel_anchors;
using test::stand_then_weave;
using test::TrackedDrive;
using test::TrackedDriveSettings;
using test::UwbPolls;

// A charging post is surveyed.
constexpr double kStartStd_m = 0.02, kStartStd_rad = 0.01;

struct TunnelRun {
  double max_error_m = 0.0;
  double max_odometry_error_m = 0.0;
  double mean_nees = 0.0;  ///< mean NEES of x, y, yaw, sampled every second
  double end_nees = 0.0;
  double end_error_m = 0.0;
  double nis_sum = 0.0;  ///< sum of the NIS of the LOS ranges
  int num_los = 0, num_nlos = 0, num_nlos_accepted = 0, num_los_refused = 0;
  std::uint64_t num_resets = 0;
};

struct TunnelSetting {
  double nlos_probability = 0.0;
  double until_s = 303.0;
  double start_error_m = 0.0;
  TrackedDriveSettings plant = {};
  double range_std_m = 0.1;
  double nlos_bias_m = 0.5;
  double antenna_delay_std_m = 0.0;  ///< constant range error of each anchor
};

/// Robot and radio whose parameters are not those that the filter assumes (noise of 10 cm, NLOS bias of 50 cm).
///
/// Ranges in line of sight by the twin's DW1000 (7 cm). A user's guide of a module with that chip gives 10 cm as three
/// standard deviations, and residual biases of 2 to 3 cm after calibration (Time Domain P330, section 6.4).
TunnelSetting of_data_sheets(double nlos_probability, double antenna_delay_std_m) {
  return {.nlos_probability = nlos_probability,
          .until_s = 63.0,
          .plant = TrackedDriveSettings::of_data_sheets(),
          .range_std_m = 0.07,
          .nlos_bias_m = 0.4,
          .antenna_delay_std_m = antenna_delay_std_m};
}

TunnelRun drive_tunnel(std::uint64_t seed, const TunnelSetting& setting) {
  const RobotDescription robot = make_tracked_robot();
  const double height = robot.tracks->body_height_m;
  TrackedDrive drive(robot, stand_then_weave(), setting.plant, seed);
  TrackOdometry odometry(robot, {});
  UwbPolls polls{.anchors = make_tunnel_anchors(-10.0, 170.0),
                 .nlos_probability = setting.nlos_probability,
                 .nlos_bias_m = setting.nlos_bias_m};
  polls.calibration.range_std_m = setting.range_std_m;
  const RandomStream delays(seed, "uwb/delays");
  for (UwbAnchor& anchor : polls.anchors) anchor.p_m.z() -= height;  // map's origin is the body at its start
  RangeFilter filter({}, polls.anchors, robot.T_body("uwb"));

  TunnelRun result;
  std::uint64_t tick = 0, step = 0;
  int seconds = 0;
  while (to_seconds(drive.now()) < setting.until_s) {
    drive.step();
    odometry.add(drive.imu());
    if (!drive.has_ticks()) continue;
    odometry.add(drive.ticks());
    const auto estimate = odometry.estimate();
    if (!estimate) continue;
    Pose3 T_map_body = drive.T_world_body();
    T_map_body.position.z() -= height;
    if (!filter.has_started()) {
      PoseEstimate start;
      start.stamp = estimate->stamp;
      // The start is known as well as it claims to be.
      const RandomStream draw(seed, "start");
      start.T_map_body = {setting.start_error_m + kStartStd_m * draw.normal(0), kStartStd_m * draw.normal(1),
                          kStartStd_rad * draw.normal(2)};
      start.covariance.diagonal() << kStartStd_m * kStartStd_m, kStartStd_m * kStartStd_m,
          kStartStd_rad * kStartStd_rad;
      filter.set_initial_pose(start, estimate->T_odom_body);
    }
    filter.predict(estimate->stamp, estimate->T_odom_body, odometry.twist_std());
    if (++step % 2 != 0) continue;
    if (auto poll = polls.poll(seed, ++tick, drive.now(), T_map_body, robot.T_body("uwb"))) {
      poll->range.range_m +=
          setting.antenna_delay_std_m * delays.normal(static_cast<std::uint64_t>(poll->range.anchor));
      const RangeOutcome outcome = filter.add(poll->range, *odometry.T_odom_body_at(poll->range.stamp));
      if (poll->is_nlos) {
        ++result.num_nlos;
        if (outcome.is_accepted()) ++result.num_nlos_accepted;
      } else {
        ++result.num_los;
        if (!outcome.is_accepted()) ++result.num_los_refused;
        result.nis_sum += outcome.nis();
      }
    }
    const PoseEstimate pose = filter.estimate(drive.now(), estimate->T_odom_body);
    const Pose2 truth = to_pose2(T_map_body);
    const Eigen::Vector3d error(pose.T_map_body.x - truth.x, pose.T_map_body.y - truth.y,
                                wrap_angle(pose.T_map_body.yaw - truth.yaw));
    result.max_error_m = std::max(result.max_error_m, error.head<2>().norm());
    result.end_error_m = error.head<2>().norm();
    result.max_odometry_error_m =
        std::max(result.max_odometry_error_m, (estimate->T_odom_body.position - T_map_body.position).head<2>().norm());
    if (to_seconds(drive.now()) >= seconds + 10.0) {
      ++seconds;
      result.end_nees = error.dot(pose.covariance.inverse() * error);
      result.mean_nees += result.end_nees;
    }
  }
  result.mean_nees /= seconds;
  result.num_resets = filter.num_resets();
  return result;
}

/// Bounds that hold 95 % of the mean of 20 chi-square values of three degrees of freedom.
constexpr double kLowNees = 40.48 / 20.0, kHighNees = 83.30 / 20.0;

TEST(RangeFilter, OverTheWholeTunnelErrsLessThanFifteenCentimetersWithThirtyPercentBlocked) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TunnelRun run = drive_tunnel(seed, {.nlos_probability = 0.3});
    EXPECT_LT(run.max_error_m, 0.15) << "seed " << seed;
    EXPECT_GT(run.max_odometry_error_m, 2.0) << "odometry alone does not do it, seed " << seed;
    EXPECT_NEAR(static_cast<double>(run.num_nlos) / (run.num_nlos + run.num_los), 0.3, 0.02);
    EXPECT_EQ(run.num_resets, 0U);
  }
}

TEST(RangeFilter, NeesAndNisOverTwentySeedsLieWithinTheirBounds) {
  double end_nees = 0.0, mean_nees = 0.0, nis = 0.0;
  int num_los = 0, num_refused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TunnelRun run = drive_tunnel(seed, {.until_s = 63.0});
    end_nees += run.end_nees;
    mean_nees += run.mean_nees;
    nis += run.nis_sum;
    num_los += run.num_los;
    num_refused += run.num_los_refused;
  }
  EXPECT_GT(end_nees / 20.0, kLowNees);
  EXPECT_LT(end_nees / 20.0, kHighNees);
  // Over time a run's values are alike but not the same: their mean lies closer than that.
  EXPECT_GT(mean_nees / 20.0, kLowNees);
  EXPECT_LT(mean_nees / 20.0, kHighNees);
  // Innovations are white: n values of mean 1 and variance 2.
  EXPECT_NEAR(nis / num_los, 1.0, 1.96 * std::sqrt(2.0 / num_los));
  EXPECT_LT(num_refused, num_los / 100) << "clear ranges are refused";
}

TEST(RangeFilter, WithBlockedRangesTheNeesStaysWithinItsBounds) {
  double end_nees = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    end_nees += drive_tunnel(seed, {.nlos_probability = 0.3, .until_s = 63.0}).end_nees;
  EXPECT_GT(end_nees / 20.0, kLowNees);
  EXPECT_LT(end_nees / 20.0, kHighNees);
}

/// Means over twenty seeds.
struct TunnelMeans {
  double end_nees = 0.0, mean_nees = 0.0, nis = 0.0;
};

TunnelMeans mean_over_seeds(const TunnelSetting& setting) {
  TunnelMeans means;
  double nis = 0.0;
  int num_los = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TunnelRun run = drive_tunnel(seed, setting);
    means.end_nees += run.end_nees / 20.0;
    means.mean_nees += run.mean_nees / 20.0;
    nis += run.nis_sum;
    num_los += run.num_los;
  }
  means.nis = nis / num_los;
  return means;
}

// The filter assumes 10 cm: the NIS is (7 / 10)^2 and the little that the pose adds.
// The lower bound is half the dimension: the odometry below it is underconfident on this plant
// (track_odometry_test.cc). Measured: 1.8 at the end, 1.9 on average.
TEST(RangeFilter, OnAPlantWithParametersOfItsOwnTheNeesIsAtLeastHalfItsDimensionAndTheNisShowsTheRangeNoise) {
  for (const double nlos_probability : {0.0, 0.3}) {
    const TunnelMeans means = mean_over_seeds(of_data_sheets(nlos_probability, 0.0));
    EXPECT_GT(means.end_nees, 1.5) << nlos_probability;
    EXPECT_LT(means.end_nees, kHighNees) << nlos_probability;
    EXPECT_GT(means.mean_nees, 1.5) << nlos_probability;
    EXPECT_LT(means.mean_nees, kHighNees) << nlos_probability;
    EXPECT_GT(means.nis, 0.49) << nlos_probability;
    EXPECT_LT(means.nis, 0.54) << nlos_probability;
  }
}

// Limit: ranges of one anchor are taken for independent. With a constant error of 3 cm for each anchor the filter
// claims half of the error that it has; with 10 cm, a fifth. The bounds are half and twice the measured value; whoever
// mends it moves this case into the test above.
TEST(RangeFilter, AntennaDelaysOf3And10CentimetersAreNotInTheCovariance) {
  for (const auto& [delay_m, measured_nees] : {std::pair{0.03, 8.4}, {0.10, 71.0}}) {
    const TunnelMeans means = mean_over_seeds(of_data_sheets(0.0, delay_m));
    EXPECT_GT(means.mean_nees, 0.5 * measured_nees) << delay_m;
    EXPECT_LT(means.mean_nees, 2.0 * measured_nees) << delay_m;
  }
}

TEST(RangeFilter, AStartTwoMetersOffIsResetAndRecovered) {
  const TunnelRun run = drive_tunnel(1, {.nlos_probability = 0.3, .until_s = 43.0, .start_error_m = 2.0});
  EXPECT_GT(run.max_error_m, 1.9);
  EXPECT_GE(run.num_resets, 1U);
  EXPECT_LT(run.end_error_m, 0.15);
}

/// Standing at map's origin with the antenna in the body's origin, one anchor 10 m ahead; no bias.
struct Standing {
  RangeFilterSettings settings;
  std::unique_ptr<RangeFilter> filter;
  Time now = std::chrono::seconds(1);

  explicit Standing(double std_m) {
    settings.bias_distance_m = settings.bias_m = {};
    settings.start_height_std_m = 0.0;
    filter = std::make_unique<RangeFilter>(settings, std::vector<UwbAnchor>{{.number = 3, .p_m = {10.0, 0.0, 0.0}}},
                                           Pose3{});
    PoseEstimate start;
    start.stamp = now;
    start.covariance.diagonal() << std_m * std_m, 1.0, 1e-4;
    filter->set_initial_pose(start, Pose3{});
  }
  RangeOutcome read(double range_m) {
    now += std::chrono::milliseconds(50);
    filter->predict(now, Pose3{}, Eigen::Vector3d::Zero());
    return filter->add({.stamp = now, .anchor = 3, .range_m = range_m}, Pose3{});
  }
};

TEST(RangeFilter, OneRangeIsTheKalmanUpdate) {
  Standing standing(0.1);
  const RangeOutcome outcome = standing.read(9.95);
  ASSERT_TRUE(outcome.is_accepted());
  EXPECT_NEAR(outcome.innovation_m, -0.05, 1e-9);
  EXPECT_NEAR(outcome.variance_m2, 0.02, 1e-6);  // 0.1^2 of the pose and 0.1^2 of the range
  // x = 0.05 P / (P + R / clear)
  const double expected = 0.05 * 0.01 / (0.01 + 0.01 / outcome.los_probability);
  const PoseEstimate estimate = standing.filter->estimate(standing.now, Pose3{});
  EXPECT_NEAR(estimate.T_map_body.x, expected, 1e-6);
  EXPECT_NEAR(estimate.T_map_body.y, 0.0, 1e-12);
  EXPECT_NEAR(estimate.covariance(1, 1), 1.0, 1e-6) << "an anchor ahead says nothing of the side";
}

TEST(RangeFilter, HalfAMeterTooLongIsBlockedAndHalfAMeterTooShortIsAnOutlier) {
  Standing standing(0.01);
  EXPECT_EQ(standing.read(10.5).status, RangeStatus::kTooLong);
  EXPECT_EQ(standing.read(9.5).status, RangeStatus::kTooShort);
  EXPECT_EQ(standing.read(10.05).status, RangeStatus::kAccepted);
  // One-sided: three sigma too long are refused, as much too short is not.
  EXPECT_EQ(standing.read(10.32).status, RangeStatus::kTooLong);
  EXPECT_EQ(standing.read(9.70).status, RangeStatus::kAccepted);
}

TEST(RangeFilter, ExcessDensityIsThatOfTheSum) {
  // Far from the gaussian's width the exponential is left: a long range is all the more likely blocked.
  Standing standing(0.01);
  double last = 1.0;
  for (const double range_m : {10.0, 10.1, 10.2, 10.3, 10.4}) {
    const double probability = standing.read(range_m).los_probability;
    EXPECT_LT(probability, last);
    last = probability;
  }
}

TEST(RangeFilter, UnusableRangesChangeNothing) {
  Standing standing(0.1);
  standing.read(10.0);
  const PoseEstimate before = standing.filter->estimate(standing.now, Pose3{});
  RangeFilter& filter = *standing.filter;
  const Time later = standing.now + std::chrono::milliseconds(10);
  EXPECT_EQ(filter.add({.stamp = later, .anchor = 99, .range_m = 9.9}, Pose3{}).status, RangeStatus::kUnusable);
  EXPECT_EQ(filter.add({.stamp = standing.now, .anchor = 3, .range_m = 9.9}, Pose3{}).status, RangeStatus::kUnusable)
      << "heard";
  EXPECT_EQ(filter.add({.stamp = later, .anchor = 3, .range_m = std::nan("")}, Pose3{}).status, RangeStatus::kUnusable);
  EXPECT_EQ(filter.add({.stamp = later, .anchor = 3, .range_m = -1.0}, Pose3{}).status, RangeStatus::kUnusable);
  EXPECT_EQ(filter.estimate(standing.now, Pose3{}).T_map_body.vector(), before.T_map_body.vector());
}

TEST(RangeFilter, AFrozenReadingIsRefusedFromItsSixthRepeat) {
  Standing standing(0.1);
  for (int repeat = 0; repeat < 5; ++repeat) EXPECT_TRUE(standing.read(10.02).is_accepted());
  EXPECT_EQ(standing.read(10.02).status, RangeStatus::kUnusable);
  EXPECT_TRUE(standing.read(10.03).is_accepted());
}

TEST(RangeFilter, NeverLocksItselfOut) {
  // Sure of a place 2 m off: all is refused at first.
  Standing standing(0.01);
  EXPECT_FALSE(standing.read(8.0).is_accepted());
  for (int read = 0; read < 200; ++read) standing.read(8.0 + 0.001 * (read % 7));
  EXPECT_GE(standing.filter->num_resets(), 1U);
  EXPECT_NEAR(standing.filter->estimate(standing.now, Pose3{}).T_map_body.x, 2.0, 0.05);
}

TEST(RangeFilter, ALateRangeIsMeasuredFromWhereTheBodyWas) {
  Standing standing(0.1);
  RangeFilter& filter = *standing.filter;
  const Pose3 now_in_odom = to_pose3({0.5, 0.0, 0.0});
  filter.predict(standing.now + std::chrono::milliseconds(500), now_in_odom, Eigen::Vector3d::Zero());
  const RangeOutcome outcome = filter.add(
      {.stamp = standing.now + std::chrono::milliseconds(200), .anchor = 3, .range_m = 9.8}, to_pose3({0.2, 0.0, 0.0}));
  EXPECT_NEAR(outcome.innovation_m, 0.0, 1e-9);
}

TEST(RangeFilter, BadSettingsAndDoubleAnchorsAreNamed) {
  EXPECT_THROW(RangeFilter({.range_std_m = 0.0}, {}, {}), InputError);
  EXPECT_THROW(RangeFilter({.bias_distance_m = {1.0, 2.0}, .bias_m = {0.1}}, {}, {}), InputError);
  EXPECT_THROW(RangeFilter({.bias_distance_m = {2.0, 1.0}, .bias_m = {0.1, 0.1}}, {}, {}), InputError);
  try {
    RangeFilter({}, {{.number = 4}, {.number = 4}}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "uwb anchor 4: duplicate number");
  }
}

}  // namespace
}  // namespace patrol::localize::range_filter_test
