#include "inspect/water/water_inversion.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/soundings.h"

namespace patrol::inspect::water_inversion_test {
namespace {

const ConductiveSphere kBody{.distance_m = 16.0, .radius_m = 6.0, .conductivity_spm = 0.6};
const Eigen::Vector3d kTowards = Eigen::Vector3d(1.0, 0.2, -0.1).normalized();

/// A quicker sampler than the robot's.
WaterSettings quick() {
  WaterSettings settings;
  settings.particles = 250;
  settings.mcmc_steps = 5;
  return settings;
}

WaterResult invert(const ConductiveSphere& body, const WaterSettings& settings = quick(),
                   const Pose2& T_map_body = {}) {
  const AntennaGeometry antenna = test::antenna_mount();
  return WaterInversion(settings).invert(
      test::make_soundings(0.003, body, kTowards, antenna_poses(settings.sounding, antenna), 1), antenna, T_map_body,
      0.1, 1);
}

TEST(WaterInversion, ABodySixteenMetresAheadIsPutWithinAMetreAndAHalfAndWarnedOf) {
  WaterSettings exact_model = quick();
  exact_model.errors.tunnel_air_std = exact_model.errors.body_shape_std = 0.0;
  const WaterResult result = invert(kBody, exact_model);
  EXPECT_EQ(result.soundings, 35);
  EXPECT_GT(result.evidence, 100.0);
  ASSERT_TRUE(result.is_found);
  EXPECT_LT((result.p_map - (Eigen::Vector3d(0.13, 0.0, 0.83) + 16.0 * kTowards)).norm(), 1.5);
  EXPECT_NEAR(result.azimuth_deg, 11.3, 1.5);
  EXPECT_NEAR(result.elevation_deg, -5.6, 1.5);
  EXPECT_NEAR(result.rock_spm, 0.003, 0.0003);
  EXPECT_LT(result.distance_low_m, 16.0);
  EXPECT_GT(result.distance_high_m, 16.0);
  EXPECT_LT(result.radius_low_m, 6.0);
  EXPECT_GT(result.radius_high_m, 6.0);
  EXPECT_EQ(result.level, WarningLevel::kAlarm);  // its nearest point is 10 m away
}

TEST(WaterInversion, InRockAloneNothingIsFoundAndTheRockIsTold) {
  const WaterResult result = invert({});
  EXPECT_LT(result.evidence, 2.0);  // the threshold is 5
  EXPECT_FALSE(result.is_found);
  EXPECT_EQ(result.level, WarningLevel::kNone);
  EXPECT_NEAR(result.rock_spm, 0.003, 0.0003);
}

TEST(WaterInversion, WhereTheRobotStoodTurnsAndMovesTheBodyInTheMap) {
  const Pose2 T_map_body{100.0, -20.0, 2.0};
  const WaterResult here = invert(kBody), there = invert(kBody, quick(), T_map_body);
  EXPECT_LT((to_pose3(T_map_body) * here.p_map - there.p_map).norm(), 1e-9);
  const Eigen::Matrix3d R = to_pose3(T_map_body).rotation.toRotationMatrix();
  EXPECT_LT((R * here.covariance_m2 * R.transpose() - there.covariance_m2).norm(), 1e-9);
  EXPECT_EQ(here.azimuth_deg, there.azimuth_deg);
}

// Strength a^3 / R^6 and decay time sigma a^2 are what is measured: twice as sure of sigma, and the distance's interval
// shrinks.
TEST(WaterInversion, TheLessIsKnownOfTheWaterTheWiderTheIntervals) {
  WaterSettings sure = quick(), unsure = quick();
  sure.prior.water_log_std = 0.05, unsure.prior.water_log_std = 0.4;
  const WaterResult narrow = invert(kBody, sure), wide = invert(kBody, unsure);
  EXPECT_GT(wide.radius_high_m - wide.radius_low_m, 2.0 * (narrow.radius_high_m - narrow.radius_low_m));
  EXPECT_GT(wide.distance_high_m - wide.distance_low_m, 1.5 * (narrow.distance_high_m - narrow.distance_low_m));
}

TEST(WaterInversion, SameSoundingsSameResult) {
  const WaterResult first = invert(kBody), again = invert(kBody);
  EXPECT_EQ(first.p_map, again.p_map);
  EXPECT_EQ(first.evidence, again.evidence);
  EXPECT_EQ(first.distance_low_m, again.distance_low_m);
}

TEST(WaterInversion, WithoutSoundingsTheResultSaysSoAndNothingElse) {
  const WaterResult result = WaterInversion({}).invert({}, test::antenna_mount(), {}, 0.0, 1);
  EXPECT_EQ(result.soundings, 0);
  EXPECT_FALSE(result.is_found);
}

std::string complaint(const WaterSettings& settings) {
  try {
    const WaterInversion inversion(settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(WaterInversion, RefusesPriorsThatLeaveNothingByName) {
  using ::testing::HasSubstr;
  WaterSettings settings;
  settings.prior.min_radius_m = 12.0;
  EXPECT_THAT(complaint(settings),
              HasSubstr("stack.inspection.water.prior.min_radius_m = 12: must be below max_radius_m"));
  settings = {};
  settings.prior.max_rock_spm = 1e-4;
  EXPECT_THAT(complaint(settings), HasSubstr("stack.inspection.water.prior.min_rock_spm"));
  settings = {};
  settings.prior.max_distance_m = 10.5;
  EXPECT_THAT(complaint(settings), HasSubstr("stack.inspection.water.prior.max_distance_m = 10.5"));
}

}  // namespace
}  // namespace patrol::inspect::water_inversion_test
