#include "sim/sensors/lidar.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/lidar_scans.h"

namespace patrol::sim::lidar_test {
namespace {

/// Walls at +-4 m in x and +-3 m in y.
const std::string kSquareRoom =
    box("4.5 0 0", "0.5 4 3") + box("-4.5 0 0", "0.5 4 3") + box("0 3.5 0", "5 0.5 3") + box("0 -3.5 0", "5 0.5 3");

/// True range in that room from its middle, along an angle.
double room_range(double angle_rad) {
  return std::min(4.0 / std::abs(std::cos(angle_rad)), 3.0 / std::abs(std::sin(angle_rad)));
}

TEST(Lidar, WithoutImperfectionsEveryBeamIsTheRoomsRangeWithin1Millimetre) {
  const SmallWorld world(kSquareRoom);
  const LaserScan scan = scans_at_rest(world, ideal(), 0.11).front();
  ASSERT_EQ(scan.ranges_m.size(), 720u);
  EXPECT_DOUBLE_EQ(scan.angle_min_rad, -kPi);
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    EXPECT_NEAR(scan.ranges_m[beam], room_range(angle_of(scan, beam)), 1e-3) << beam;
  }
}

TEST(Lidar, TenTimesASecondAScanWhoseBeamsFollowOneAnotherEvenlyAndWhoseLastEndsTheRevolution) {
  const SmallWorld world(kSquareRoom);
  const std::vector<LaserScan> scans = scans_at_rest(world, ideal(), 1.001);
  ASSERT_EQ(scans.size(), 10u);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_NEAR(scans[i].scan_time_s, 0.1, 1e-12);
    EXPECT_NEAR(scans[i].time_increment_s, 0.1 / 720.0, 1e-12);
    EXPECT_NEAR(to_seconds(scans[i].stamp) + 719.0 * scans[i].time_increment_s, 0.1 * static_cast<double>(i + 1), 1e-8);
  }
}

TEST(Lidar, A270DegreeScannerAt40HertzSpreadsItsBeamsOverThreeQuartersOfTheRevolution) {
  const SmallWorld world(kSquareRoom);
  const LidarSettings settings = LidarSettings::of_preset("utm30lx");
  const LaserScan scan = scans_at_rest(world, settings, 0.03).front();
  EXPECT_EQ(scan.ranges_m.size(), 1081u);
  EXPECT_NEAR(scan.angle_increment_rad, 0.25 * kDegree, 1e-6);
  EXPECT_NEAR(scan.time_increment_s, 0.025 * 270.25 / 360.0 / 1081.0, 1e-12);
  EXPECT_NEAR(to_seconds(scan.stamp) + 1080.0 * scan.time_increment_s, 0.025, 1e-8);
}

test::Moments range_errors(const SmallWorld& world, const LidarSettings& settings, double seconds, double distance_m,
                           std::uint64_t seed = 1) {
  test::Moments errors;
  for (const LaserScan& scan : scans_at_rest(world, settings, seconds, seed)) {
    for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
      if (std::isfinite(scan.ranges_m[beam]))
        errors.add(scan.ranges_m[beam] - distance_m / std::cos(angle_of(scan, beam)));
    }
  }
  return errors;
}

TEST(Lidar, RangeNoiseIs15MillimetresAndWithoutBias) {
  const SmallWorld world(kWallAt2m);
  LidarSettings settings = narrow();
  settings.range_noise_std_m = 0.015;
  const test::Moments errors = range_errors(world, settings, 1.01, 2.0);
  EXPECT_GE(errors.count, 19000);
  EXPECT_NEAR(errors.std(), 0.015, 0.0003);
  EXPECT_NEAR(errors.mean(), 0.0, 0.0005);
}

TEST(Lidar, RangesAreWholeStepsOf13MillimetresAndTheErrorIsThatOfAnEvenSpread) {
  const SmallWorld world(box("2.5 0 0", "0.5 20 5", kWhite + R"(euler="0 0 20")"));
  LidarSettings settings = narrow();
  settings.fov_deg = 20.0;
  settings.range_quantization_m = 0.013;
  const LaserScan coarse = scans_at_rest(world, settings, 0.03).front();
  settings.range_quantization_m = 0.0;
  const LaserScan exact = scans_at_rest(world, settings, 0.03).front();
  test::Moments errors;
  for (std::size_t beam = 0; beam < coarse.ranges_m.size(); ++beam) {
    EXPECT_NEAR(std::remainder(static_cast<double>(coarse.ranges_m[beam]), 0.013), 0.0, 1e-6);
    errors.add(coarse.ranges_m[beam] - exact.ranges_m[beam]);
  }
  EXPECT_NEAR(errors.std(), 0.013 / std::sqrt(12.0), 0.0003);
  EXPECT_LE(errors.largest, 0.0066);
}

TEST(Lidar, Rep117TooCloseIsMinusInfinityNothingPlusInfinityLostNotANumber) {
  const SmallWorld near(box("0.53 0 0", "0.5 20 5"));
  EXPECT_EQ(scans_at_rest(near, narrow(), 0.03).front().ranges_m.at(200), -kInfinity);
  LidarSettings settings = narrow();
  settings.range_max_m = 30.0;
  const SmallWorld far(box("30.6 0 0", "0.5 20 5"));
  EXPECT_EQ(scans_at_rest(far, settings, 0.03).front().ranges_m.at(200), kInfinity);
  const SmallWorld just(box("30.4 0 0", "0.5 20 5"));
  EXPECT_NEAR(scans_at_rest(just, settings, 0.03).front().ranges_m.at(200), 29.9, 1e-3);
  settings.dropout_probability = 1.0;
  EXPECT_TRUE(std::isnan(scans_at_rest(just, settings, 0.03).front().ranges_m.at(200)));
}

TEST(Lidar, DropsTwoOfAThousandBeams) {
  const SmallWorld world(kWallAt2m);
  LidarSettings settings = narrow();
  settings.dropout_probability = 0.002;
  int lost = 0, all = 0;
  for (const LaserScan& scan : scans_at_rest(world, settings, 5.01)) {
    for (const float range : scan.ranges_m) lost += std::isnan(range), ++all;
  }
  EXPECT_GE(all, 99000);
  EXPECT_NEAR(static_cast<double>(lost) / all, 0.002, 4.0 * std::sqrt(0.002 / all));
}

TEST(Lidar, AdditionalNoiseOf5CentimetersChangesATenthOfTheRanges) {
  const SmallWorld world(kWallAt2m);
  LidarSettings settings = narrow();
  const std::vector<LaserScan> exact = scans_at_rest(world, settings, 5.01);
  settings.wide_noise_probability = 0.1;
  settings.wide_noise_std_m = 0.05;
  const std::vector<LaserScan> noisy = scans_at_rest(world, settings, 5.01);
  test::Moments errors;
  int changed = 0, all = 0;
  for (std::size_t scan = 0; scan < exact.size(); ++scan) {
    for (std::size_t beam = 0; beam < exact[scan].ranges_m.size(); ++beam) {
      const double error_m = noisy[scan].ranges_m[beam] - exact[scan].ranges_m[beam];
      ++all;
      if (error_m == 0.0) continue;
      ++changed;
      errors.add(error_m);
    }
  }
  EXPECT_GE(all, 99000);
  EXPECT_NEAR(static_cast<double>(changed) / all, 0.1, 4.0 * std::sqrt(0.09 / all));
  EXPECT_NEAR(errors.std(), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * changed));
  EXPECT_NEAR(errors.mean(), 0.0, 4.0 * 0.05 / std::sqrt(changed));
}

TEST(Lidar, AngularJitterOfATenthOfADegreeIsReadOffAWallMetAt60Degrees) {
  // At 60 degrees to the normal of a wall 2 m away the range changes by r tan(60 deg) = 6.93 m per radian.
  const SmallWorld world(box("2.5 0 0", "0.5 20 5"));
  LidarSettings settings = narrow();
  settings.angle_noise_std_deg = 0.1;
  Lidar lidar(settings, world.scene, {Eigen::Vector3d::Zero(), quaternion_from_yaw(60.0 * kDegree)}, kRayLidar2d, 1,
              "lidar");
  test::Moments errors;
  for (Time now{}; now < from_seconds(0.5); now += kTick) {
    lidar.advance(now, now + kTick, {}, {});
    for (const LaserScan& scan : lidar.take_scans()) {
      for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
        const double angle = angle_of(scan, beam) + 60.0 * kDegree, range = 2.0 / std::cos(angle);
        errors.add((scan.ranges_m[beam] - range) / (range * std::tan(angle)));  // rad
      }
    }
  }
  EXPECT_NEAR(errors.std(), 0.1 * kDegree, 0.02 * 0.1 * kDegree);
  EXPECT_NEAR(errors.mean(), 0.0, 0.03 * 0.1 * kDegree);
}

TEST(Lidar, OnARobotTurningAt1RadianPerSecondEachBeamLooksWhereItStoodAtItsInstant) {
  const SmallWorld world(kSquareRoom);
  const auto turning = [](double now) { return Pose3{Eigen::Vector3d::Zero(), quaternion_from_yaw(now)}; };
  LidarSettings settings = ideal();
  const LaserScan scan = scans_along(world, settings, 0.31, turning).back();
  settings.motion_distortion = false;
  const LaserScan frozen = scans_along(world, settings, 0.31, turning).back();
  double largest = 0.0;
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double instant = to_seconds(scan.stamp) + static_cast<double>(beam) * scan.time_increment_s;
    EXPECT_NEAR(scan.ranges_m[beam], room_range(angle_of(scan, beam) + instant), 1e-3) << beam;
    EXPECT_NEAR(frozen.ranges_m[beam], room_range(angle_of(scan, beam) + to_seconds(frozen.stamp)), 1e-3) << beam;
    largest = std::max(largest, static_cast<double>(std::abs(scan.ranges_m[beam] - frozen.ranges_m[beam])));
  }
  EXPECT_GT(largest, 0.2);  // a tenth of a radian at the first beam
  EXPECT_EQ(frozen.time_increment_s, 0.0);
}

TEST(Lidar, OnARobotWalkingAt1MetrePerSecondTheWallAheadComesNearerByOneMillimetreAMillisecond) {
  const SmallWorld world(box("10.5 0 0", "0.5 20 5"));
  const auto walking = [](double now) { return Pose3{Eigen::Vector3d(now, 0, 0), Eigen::Quaterniond::Identity()}; };
  LidarSettings settings = ideal();
  settings.fov_deg = 100.0;
  const LaserScan scan = scans_along(world, settings, 0.21, walking).back();
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double instant = to_seconds(scan.stamp) + static_cast<double>(beam) * scan.time_increment_s;
    EXPECT_NEAR(scan.ranges_m[beam], (10.0 - instant) / std::cos(angle_of(scan, beam)), 1e-3) << beam;
  }
}

TEST(Lidar, StabilizedItMeasuresTheLevelRoomWhateverTheBodyDoes) {
  const SmallWorld world(kSquareRoom);
  const auto wobbling = [](double t) {
    return Pose3{Eigen::Vector3d::Zero(),
                 quaternion_from_rpy(0.05 * std::sin(20.0 * t), 0.05 * std::sin(30.0 * t), 0.0)};
  };
  LidarSettings settings = ideal();
  const auto worst_error_m = [&] {
    const LaserScan scan = scans_along(world, settings, 0.11, wobbling).front();
    double worst = 0.0;
    for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
      worst = std::max(worst, std::abs(scan.ranges_m[beam] - room_range(angle_of(scan, beam))));
    }
    return worst;
  };
  EXPECT_GT(worst_error_m(), 0.003);  // a wall 3 m off at 0.05 rad: 3 (1 / cos 0.05 - 1) = 3.8 mm
  settings.stabilized = true;
  EXPECT_LT(worst_error_m(), 1e-3);
}

TEST(Lidar, SixteenRingsGiveACloudOverPlusMinus15DegreesWithTimesAndRings) {
  const SmallWorld world(kSquareRoom + R"(<geom type="plane" pos="0 0 -1" size="20 20 1" rgba="1 1 1 1"/>)");
  LidarSettings settings = LidarSettings::of_preset("vlp16");
  settings.range_noise_std_m = settings.range_quantization_m = settings.angle_noise_std_deg =
      settings.dropout_probability = settings.beam_width_deg = 0.0;
  Lidar lidar(settings, world.scene, {}, kRayLidar3d, 1, "lidar3d");
  std::vector<PointCloud> clouds;
  for (Time now{}; now < from_seconds(0.101); now += kTick) {
    lidar.advance(now, now + kTick, {}, {});
    for (PointCloud& cloud : lidar.take_clouds()) clouds.push_back(std::move(cloud));
  }
  ASSERT_EQ(clouds.size(), 1u);
  EXPECT_EQ(clouds[0].points.size(), 16u * 1800u);
  for (const CloudPoint& point : clouds[0].points) {
    const double across = std::hypot(point.x, point.y), elevation = std::atan2(point.z, across);
    EXPECT_NEAR(elevation, (-15.0 + 2.0 * point.ring) * kDegree, 1e-5);
    EXPECT_LT(point.time_s, 0.1f);
    const double wall = room_range(std::atan2(point.y, point.x));
    const double expected = elevation < 0.0 ? std::min(wall, 1.0 / std::tan(-elevation)) : wall;
    EXPECT_NEAR(across, expected, 2e-3);
  }
}

TEST(Lidar, SwitchingOneImperfectionOffChangesNoOtherDraw) {
  const SmallWorld world(kWallAt2m);
  LidarSettings all = narrow();
  all.range_noise_std_m = 0.015;
  all.angle_noise_std_deg = 0.05;
  all.dropout_probability = 0.05;
  all.false_return_rate_per_m = 0.01;
  LidarSettings no_jitter = all, no_dropout = all, no_noise = all;
  no_jitter.angle_noise_std_deg = 0.0;
  no_dropout.dropout_probability = 0.0;
  no_noise.range_noise_std_m = 0.0;
  const LaserScan base = scans_at_rest(world, all, 0.03, 5).front(),
                  a = scans_at_rest(world, no_jitter, 0.03, 5).front(),
                  b = scans_at_rest(world, no_dropout, 0.03, 5).front(),
                  c = scans_at_rest(world, no_noise, 0.03, 5).front();
  for (std::size_t beam = 0; beam < base.ranges_m.size(); ++beam) {
    EXPECT_EQ(std::isnan(base.ranges_m[beam]), std::isnan(a.ranges_m[beam])) << beam;
    EXPECT_EQ(std::isnan(base.ranges_m[beam]), std::isnan(c.ranges_m[beam])) << beam;
    if (std::isnan(base.ranges_m[beam])) continue;
    EXPECT_NEAR(base.ranges_m[beam], a.ranges_m[beam], 2e-4) << beam;  // jitter barely shows at right angles
    EXPECT_EQ(base.ranges_m[beam], b.ranges_m[beam]) << beam;
  }
}

TEST(Lidar, TheSameSeedGivesTheSameScansAndAnotherSeedOthers) {
  const SmallWorld world(kSquareRoom);
  const LidarSettings settings;
  const auto ranges = [&](std::uint64_t seed) { return scans_at_rest(world, settings, 0.11, seed).front().ranges_m; };
  const std::vector<float> first = ranges(1), again = ranges(1), other = ranges(2);
  int differing = 0;
  for (std::size_t beam = 0; beam < first.size(); ++beam) {
    EXPECT_TRUE(first[beam] == again[beam] || (std::isnan(first[beam]) && std::isnan(again[beam])));
    differing += first[beam] != other[beam];
  }
  EXPECT_GT(differing, 1000);
}

TEST(Lidar, OutOfRangeSettingsAreRefused) {
  const SmallWorld world(kSquareRoom);
  LidarSettings settings;
  settings.dropout_probability = 1.5;
  EXPECT_THROW(Lidar(settings, world.scene, {}, kRayLidar2d, 1, "lidar"), InputError);
}

}  // namespace
}  // namespace patrol::sim::lidar_test
