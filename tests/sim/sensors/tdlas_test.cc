#include "sim/sensors/tdlas.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/small_world.h"

namespace patrol::sim::tdlas_test {
namespace {

const std::string kWallAt10m = R"(<geom type="box" pos="10.5 0 1" size="0.5 5 2"/>)";
const GasPlume kNoGas(Eigen::Vector3d::Zero(), 0.0, {});

/// Nothing but the background and the leak.
TdlasSettings ideal() {
  TdlasSettings settings;
  settings.noise_std_ppm_m = settings.relative_noise_std = settings.resolution_ppm_m = 0.0;
  return settings;
}

Pose3 eye() { return {Eigen::Vector3d(0, 0, 1), Eigen::Quaterniond::Identity()}; }

TEST(Tdlas, BackgroundOver10MetresReads19ppm_m) {
  const SmallWorld world(kWallAt10m);
  const GasReading reading = Tdlas(ideal(), 1).read(world.scene, kNoGas, eye(), Time{}, 0);
  EXPECT_NEAR(reading.path_length_m, 10.0, 1e-5);
  EXPECT_NEAR(reading.column_ppm_m, 19.0, 1e-4);
}

TEST(Tdlas, OnePpmOfMethaneIs0_668mgPerCubicMetreAt20DegreesAndOneAtmosphere) {
  // Molar mass 16.043 g/mol over the molar volume R T / p = 24.055 l/mol; methane is 0.2 % denser than an
  // ideal gas.
  EXPECT_NEAR(kMethaneDensity_kgpm3, 16.043e-3 / (8.314462 * 293.15 / 101325.0) * 1.002, 0.0005);
  const SmallWorld world(kWallAt10m);
  const GasReading reading = Tdlas(ideal(), 1).read(world.scene, kNoGas, eye(), Time{}, 0);
  EXPECT_NEAR(reading.mean_mg_m3, 1.9 * kMethaneDensity_kgpm3, 1e-6);
}

TEST(Tdlas, AddsTheColumnOfTheLeakToTheBackground) {
  const SmallWorld world(kWallAt10m);
  const GasPlume plume({5, 0, 1}, 1.0, {});
  const GasReading reading = Tdlas(ideal(), 1).read(world.scene, plume, eye(), Time{}, 0);
  const double leak = plume.column_ppm_m({0, 0, 1}, {1, 0, 0}, 10.0, 0.0);
  EXPECT_GT(leak, 100.0);
  EXPECT_NEAR(reading.column_ppm_m, 19.0 + leak, 1e-3 * leak);
}

TEST(Tdlas, WithoutASurfaceWithin30MetresThereIsNoReading) {
  const SmallWorld world(R"(<geom type="box" pos="31 0 1" size="0.5 5 2"/>)");
  const GasReading reading = Tdlas(ideal(), 1).read(world.scene, kNoGas, eye(), Time{}, 0);
  EXPECT_TRUE(std::isinf(reading.path_length_m));
  EXPECT_EQ(reading.column_ppm_m, 0.0);
}

TEST(Tdlas, NoiseIs10ppm_mAnd5PercentOfTheColumn) {
  const SmallWorld world(kWallAt10m);
  TdlasSettings settings;
  settings.resolution_ppm_m = 0.0;
  settings.background_ppm = 100.0;  // 1000 ppm m over 10 m
  const Tdlas tdlas(settings, 7);
  test::Moments column;
  for (std::uint64_t tick = 0; tick < 20000; ++tick) {
    column.add(tdlas.read(world.scene, kNoGas, eye(), Time{}, tick).column_ppm_m);
  }
  // 20,000 draws give the standard deviation to 0.5 % (one sigma).
  EXPECT_NEAR(column.mean(), 1000.0, 2.0);
  const double expected = std::hypot(10.0, 0.05 * 1000.0);
  EXPECT_NEAR(column.std(), expected, 0.02 * expected);
}

TEST(Tdlas, ReadsWholePpm_mAndStopsAt50000) {
  const SmallWorld world(kWallAt10m);
  TdlasSettings settings;
  const Tdlas tdlas(settings, 3);
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const double column = tdlas.read(world.scene, kNoGas, eye(), Time{}, tick).column_ppm_m;
    EXPECT_EQ(column, std::round(column));
    EXPECT_GE(column, 0.0);
  }
  settings.background_ppm = 1e5;
  EXPECT_EQ(Tdlas(settings, 3).read(world.scene, kNoGas, eye(), Time{}, 0).column_ppm_m, 50000.0);
}

TEST(Tdlas, SwitchingTheRelativeNoiseOffLeavesTheOtherDrawsAsTheyWere) {
  const SmallWorld world(kWallAt10m);
  TdlasSettings absolute = ideal(), relative = ideal();
  absolute.background_ppm = relative.background_ppm = 100.0;
  absolute.noise_std_ppm_m = 10.0;
  relative.relative_noise_std = 0.05;
  TdlasSettings both = absolute;
  both.relative_noise_std = 0.05;
  const auto error = [&](const TdlasSettings& settings, std::uint64_t tick) {
    return Tdlas(settings, 5).read(world.scene, kNoGas, eye(), Time{}, tick).column_ppm_m - 1000.0;
  };
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    EXPECT_NEAR(error(both, tick), error(absolute, tick) + error(relative, tick), 1e-2);
  }
}

}  // namespace
}  // namespace patrol::sim::tdlas_test
