#include "sim/as_built/uwb_power.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/uwb.h"
#include "sim/sensors/uwb.h"
#include "tests/sim/small_world.h"
#include "tests/support/moments.h"

namespace patrol::sim::uwb_power_test {
namespace {

Eigen::Vector3d direction(double azimuth_rad) { return {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0}; }

TEST(UwbPower, IsZeroWithoutToleranceAndAtItsOwnSeedAlwaysTheSame) {
  EXPECT_EQ(UwbPower(0.0, 3).offset_db(2, direction(0.4)), 0.0);
  EXPECT_NEAR(UwbPower(1.5, 3).offset_db(2, direction(0.4)), UwbPower(1.5, 3).offset_db(2, 7.0 * direction(0.4)),
              1e-12);
  EXPECT_NE(UwbPower(1.5, 3).offset_db(2, direction(0.4)), UwbPower(1.5, 3).offset_db(1, direction(0.4)));
}

// Over seeds, three parts of one standard deviation each; those of one robot share the gain of its antenna.
TEST(UwbPower, SumsTheGainsOfRobotAnchorAndDirection) {
  constexpr int kSeeds = 4000;
  test::Moments offset, difference, around;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const UwbPower power(2.0, seed);
    offset.add(power.offset_db(1, direction(0.7)));
    difference.add(power.offset_db(1, direction(0.7)) - power.offset_db(4, direction(0.7)));
    around.add(power.offset_db(1, direction(0.7)) - power.offset_db(1, direction(0.7 + std::numbers::pi)));
  }
  const double tol = 4.0 / std::sqrt(2.0 * kSeeds);
  EXPECT_NEAR(offset.std() / (2.0 * std::sqrt(3.0)), 1.0, tol);
  EXPECT_NEAR(difference.std() / 4.0, 1.0, tol);
  EXPECT_NEAR(around.std() / 4.0, 1.0, tol);
}

TEST(UwbPower, ShiftsTheBiasCurveSoThatTheStacksCorrectionNoLongerFits) {
  EXPECT_EQ(uwb_range_bias_m(8.0), uwb_range_bias_m(8.0, 0.0));
  EXPECT_NEAR(uwb_range_bias_m(8.0, 6.0), uwb_range_bias_m(8.0 / std::pow(10.0, 6.0 / 20.0)), 1e-12);
  const SmallWorld world("<site name=\"uwb_anchor_1\" pos=\"8 0 1\"/>");
  UwbSettings settings;
  settings.range_noise_std_m = settings.loss_probability = 0.0;
  settings.range_max_m = 1000.0;
  test::Moments residual;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Uwb uwb(settings, *world.model, seed, UwbPower(2.0, seed));
    const auto range = uwb.read(world.scene, {0.0, 0.0, 1.0}, Time{}, 0);
    ASSERT_TRUE(range);
    residual.add(range->range_m - 8.0 - uwb_bias_at({}, 8.0).bias_m);
  }
  EXPECT_NEAR(residual.std(), 0.04, 0.01);  // 3.5 dB on a slope of 12 mm/dB
  Uwb nominal(settings, *world.model, 1);
  EXPECT_NEAR(nominal.read(world.scene, {0.0, 0.0, 1.0}, Time{}, 0)->range_m - 8.0, uwb_bias_at({}, 8.0).bias_m, 0.003);
}

}  // namespace
}  // namespace patrol::sim::uwb_power_test
