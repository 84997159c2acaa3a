#include "slam/planar_scan.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::slam::planar_scan_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Beams to the right, ahead and to the left of a lidar that stands 0.5 m before the body and looks a quarter turn to
/// the left.
RecordedScan make_scan(const std::vector<float>& ranges_m) {
  RecordedScan recorded;
  recorded.scan.stamp = from_seconds(3.5);
  recorded.scan.angle_min_rad = -0.5 * std::numbers::pi;
  recorded.scan.angle_increment_rad = 0.5 * std::numbers::pi;
  recorded.scan.ranges_m = ranges_m;
  recorded.T_body_lidar = {0.5, 0.0, 0.5 * std::numbers::pi};
  return recorded;
}

TEST(PlanarScan, EndsOfBeamsLieInTheBodysFrame) {
  const LevelScan scan = planar_scan(make_scan({1.0F, 2.0F, 3.0F}), {});
  EXPECT_EQ(scan.stamp, from_seconds(3.5));
  EXPECT_THAT(scan.origin_m, test::VectorNear(Eigen::Vector2d(0.5, 0.0), 1e-12));
  ASSERT_EQ(scan.beams.size(), 3U);
  EXPECT_THAT(scan.beams[0].end_m, test::VectorNear(Eigen::Vector2f(1.5F, 0.0F), 1e-6));
  EXPECT_THAT(scan.beams[1].end_m, test::VectorNear(Eigen::Vector2f(0.5F, 2.0F), 1e-6));
  EXPECT_THAT(scan.beams[2].end_m, test::VectorNear(Eigen::Vector2f(-2.5F, 0.0F), 1e-6));
  for (const LevelScan::Beam& beam : scan.beams) EXPECT_TRUE(beam.is_hit);
}

// The body goes 0.4 m ahead and turns by 0.2 rad: half of it until the second beam of three.
TEST(PlanarScan, BeamsAreInTheFrameOfTheFirstOne) {
  RecordedScan recorded = make_scan({1.0F, 2.0F, 3.0F});
  recorded.T_begin_end = {0.4, 0.0, 0.2};
  const LevelScan scan = planar_scan(recorded, {});
  EXPECT_THAT(scan.beams[0].end_m, test::VectorNear(Eigen::Vector2f(1.5F, 0.0F), 1e-6));
  const Eigen::Vector2d second = Pose2{0.2, 0.0, 0.1} * Eigen::Vector2d(0.5, 2.0),
                        third = recorded.T_begin_end * Eigen::Vector2d(-2.5, 0.0);
  EXPECT_THAT(scan.beams[1].end_m, test::VectorNear(Eigen::Vector2f(second.cast<float>()), 1e-6));
  EXPECT_THAT(scan.beams[2].end_m, test::VectorNear(Eigen::Vector2f(third.cast<float>()), 1e-6));
}

TEST(PlanarScan, FarReturnsClearUpToTheLimitAndInvalidOrNearOnesAreDropped) {
  const LevelScan scan =
      planar_scan(make_scan({50.0F, std::numeric_limits<float>::quiet_NaN(), 0.01F}), {.max_range_m = 10.0});
  ASSERT_EQ(scan.beams.size(), 1U);
  EXPECT_FALSE(scan.beams[0].is_hit);
  EXPECT_THAT(scan.beams[0].end_m, test::VectorNear(Eigen::Vector2f(10.5F, 0.0F), 1e-5));
}

TEST(PlanarScan, ABeamWithoutReturnIsFreeOnlyAsFarAsIsAskedFor) {
  EXPECT_TRUE(planar_scan(make_scan({kInfinity, kInfinity, -kInfinity}), {}).beams.empty());
  const LevelScan scan =
      planar_scan(make_scan({kInfinity, kInfinity, -kInfinity}), {.no_return_clearing_range_m = 6.0});
  ASSERT_EQ(scan.beams.size(), 2U);
  EXPECT_FALSE(scan.beams[0].is_hit);
  EXPECT_THAT(scan.beams[0].end_m, test::VectorNear(Eigen::Vector2f(6.5F, 0.0F), 1e-6));
}

TEST(PlanarScan, NoisyRangesAreSmoothedIfTheirNoiseIsGiven) {
  RecordedScan recorded;
  recorded.scan.angle_min_rad = -0.1;
  recorded.scan.angle_increment_rad = 0.02;
  recorded.scan.ranges_m = {2.0F, 2.1F, 1.9F, 2.0F, 2.1F, 1.9F, 2.0F, 2.1F, 1.9F, 2.0F, 2.0F};
  EXPECT_EQ(planar_scan(recorded, {}).beams[5].end_m.x(), 1.9F);
  EXPECT_NEAR(planar_scan(recorded, {.range_std_m = 0.1}).beams[5].end_m.x(), 2.0F, 0.03F);
}

}  // namespace
}  // namespace patrol::slam::planar_scan_test
