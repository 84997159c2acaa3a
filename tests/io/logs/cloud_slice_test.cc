#include "io/logs/cloud_slice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/geometry/angles.h"
#include "tests/io/log_messages.h"

namespace patrol::io::cloud_slice_test {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
const Eigen::Quaterniond kLevel = Eigen::Quaterniond::Identity();

/// One turn in 0.1 s from the azimuth `start_rad`, of a lidar with 16 beams of -15 to 15 degrees inside a cylinder of
/// radius 5 m. `direction`: 1 is counterclockwise.
PointCloud turn_in_cylinder(double start_rad, double direction, bool has_times = true) {
  PointCloud cloud;
  constexpr int kColumns = 1800;
  for (int column = 0; column < kColumns; ++column) {
    const double part = static_cast<double>(column) / kColumns, azimuth = start_rad + direction * kTurn_rad * part;
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = to_rad(2.0 * ring - 15.0);
      const Eigen::Vector3d wall(5.0 * std::cos(azimuth), 5.0 * std::sin(azimuth), 5.0 * std::tan(elevation));
      cloud.points.push_back(test::cloud_point_at(wall, has_times ? 0.1 * part : 0.0, ring));
    }
  }
  return cloud;
}

TEST(CloudSlice, BeamsOfASpinningLidarFollowItsRotation) {
  for (const double direction : {1.0, -1.0}) {
    for (const double start_rad : {-3.0, 0.0, 2.5}) {
      SCOPED_TRACE(testing::Message() << direction << " from " << start_rad);
      const LaserScan scan = planar_slice(turn_in_cylinder(start_rad, direction), kLevel, {});
      ASSERT_EQ(scan.ranges_m.size(), 720U);
      EXPECT_NEAR(std::remainder(scan.angle_min_rad - start_rad, kTurn_rad), 0.0, 0.02);
      EXPECT_DOUBLE_EQ(scan.angle_increment_rad, direction * kTurn_rad / 720.0);
      EXPECT_NEAR(scan.time_increment_s, 0.1 / 720.0, 2e-6);
      for (const float range_m : scan.ranges_m) EXPECT_NEAR(range_m, 5.0F, 1e-5F);
    }
  }
}

TEST(CloudSlice, ACloudWithoutTimesBeginsAtMinus180DegreesWithoutTimesOfBeams) {
  const LaserScan scan = planar_slice(turn_in_cylinder(1.0, 1.0, false), kLevel, {});
  EXPECT_EQ(scan.angle_min_rad, -std::numbers::pi);
  EXPECT_EQ(scan.time_increment_s, 0.0);
}

TEST(CloudSlice, TimesThatDoNotTurnAreNotUsed) {
  PointCloud cloud = turn_in_cylinder(0.0, 1.0);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)  // a rosette
    cloud.points[i].time_s = static_cast<float>(0.1 * static_cast<double>(i * 7919 % cloud.points.size())) /
                             static_cast<float>(cloud.points.size());
  EXPECT_EQ(planar_slice(cloud, kLevel, {}).time_increment_s, 0.0);
}

TEST(CloudSlice, TheNearestPointBetweenTheHeightsIsTheRangeAndAnEmptySectorIsNotANumber) {
  PointCloud cloud;
  const auto add = [&](double x, double z) { cloud.points.push_back(test::cloud_point_at({x, 0.0, z})); };
  add(1.0, -0.25);  // below
  add(1.5, 0.6);    // above
  add(3.0, 0.0);
  add(2.0, 0.4);
  add(4.0, 0.0);
  const LaserScan scan = planar_slice(cloud, kLevel, {});
  EXPECT_EQ(scan.ranges_m[360], 2.0F);
  EXPECT_EQ(
      std::count_if(scan.ranges_m.begin(), scan.ranges_m.end(), [](float range_m) { return std::isnan(range_m); }),
      719);
}

TEST(CloudSlice, HeightsAreAboveTheLidarWhenItIsMountedTilted) {
  PointCloud cloud;
  const Eigen::Quaterniond R_level_lidar = quaternion_from_rpy(0.0, 0.5, 0.0);
  cloud.points.push_back(test::cloud_point_at(R_level_lidar.conjugate() * Eigen::Vector3d(0.0, 6.0, 0.1)));
  EXPECT_NEAR(planar_slice(cloud, R_level_lidar, {}).ranges_m[540], 6.0F, 1e-5F);
}

}  // namespace
}  // namespace patrol::io::cloud_slice_test
