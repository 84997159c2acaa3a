// What surfaces, weather and edges do to the lidar's beams.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/lidar_scans.h"

namespace patrol::sim::lidar_surfaces_test {
namespace {

TEST(LidarSurfaces, GrazingBeamsBeyond85DegreesAreLost) {
  const SmallWorld world(R"(<geom type="plane" size="100 100 1" rgba="1 1 1 1"/>)");
  LidarSettings settings = narrow();
  settings.max_incidence_deg = 85.0;
  const auto range_looking_down = [&](double degrees) {
    const Pose3 pose{Eigen::Vector3d(0, 0, 1),
                     Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitY()))};
    return scans_along(world, settings, 0.03, [&](double) { return pose; }).front().ranges_m.at(200);
  };
  EXPECT_NEAR(range_looking_down(5.2), 1.0 / std::sin(5.2 * kDegree), 1e-2);
  EXPECT_EQ(range_looking_down(4.8), kInfinity);
}

TEST(LidarSurfaces, ASurfaceOf10PercentReturnsUpTo10MetresAndAWhiteOneUpTo30) {
  LidarSettings settings = narrow();
  settings.max_range_10pct_m = 10.0;
  const auto range_at = [&](double distance_m, const std::string& grey) {
    const SmallWorld world(box(std::to_string(distance_m + 0.5) + " 0 0", "0.5 20 5",
                               R"(rgba=")" + grey + " " + grey + " " + grey + R"( 1")"));
    return scans_at_rest(world, settings, 0.03).front().ranges_m.at(200);
  };
  EXPECT_NEAR(range_at(9.9, "0.1"), 9.9, 1e-3);
  EXPECT_EQ(range_at(10.1, "0.1"), kInfinity);
  EXPECT_NEAR(range_at(19.9, "0.4"), 19.9, 1e-3);  // range grows with the root of the reflectivity
  EXPECT_EQ(range_at(20.1, "0.4"), kInfinity);
  EXPECT_NEAR(range_at(29.5, "1"), 29.5, 1e-3);
}

TEST(LidarSurfaces, GlassReturnsTheBeamOnlyWithin5DegreesOfItsNormal) {
  const SmallWorld world(box("2.5 0 0", "0.5 20 5", R"(material="window_glass")"),
                         R"(<material name="window_glass" rgba="1 1 1 1"/>)");
  LidarSettings settings = ideal();
  settings.fov_deg = 40.0;
  const LaserScan scan = scans_at_rest(world, settings, 0.11).front();
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double degrees = std::abs(angle_of(scan, beam)) / kDegree;
    if (std::abs(degrees - 5.1) < 0.2) continue;
    EXPECT_EQ(std::isfinite(scan.ranges_m[beam]), degrees < 5.1) << degrees;
  }
}

TEST(LidarSurfaces, RainOfOnePerCentAMetreShortensTheShareOfBeamsThatBeersLawSays) {
  const SmallWorld world(box("10.5 0 0", "0.5 20 5"));
  LidarSettings settings = narrow();
  settings.false_return_rate_per_m = 0.01;
  test::Moments drops;
  int all = 0;
  for (const LaserScan& scan : scans_at_rest(world, settings, 1.01)) {
    for (const float range : scan.ranges_m) {
      ++all;
      if (std::abs(range) < 9.9f) drops.add(range);
    }
  }
  EXPECT_NEAR(static_cast<double>(drops.count) / all, (1.0 - std::exp(-0.1)) * 0.99, 0.007);
}

/// One scan of 400 narrow beams squarely at a white wall, through dust.
LaserScan scan_in_dust(double wall_m, const DustSettings& dust, const LidarSettings& settings) {
  const SmallWorld world(box(std::to_string(wall_m + 0.5) + " 0 0", "0.5 20 5"));
  Lidar lidar(settings, world.scene, {}, kRayLidar2d, 1, "lidar", dust);
  for (Time now{};; now += kTick) {
    lidar.advance(now, now + kTick, {}, {});
    const auto scans = lidar.take_scans();
    if (!scans.empty()) return scans.front();
  }
}

// White is seen to 30 m in clear air. Light falls by ln 50 / 20 m = 0.1956 / m: at 9 m it is as from 9 exp(1.760)
// = 52.3 m, at 7 m as from 7 exp(1.369) = 27.5 m.
TEST(LidarSurfaces, InDustOf20MetresVisibilityAWhiteWallIsSeenAt7MetresAndNotAt9) {
  LidarSettings settings = narrow();
  settings.max_range_10pct_m = 10.0;
  const DustSettings dust{.enabled = true, .visibility_m = 20.0, .backscatter_probability = 0.0};
  EXPECT_NEAR(scan_in_dust(7.0, dust, settings).ranges_m.at(200), 7.0, 1e-3);
  EXPECT_EQ(scan_in_dust(9.0, dust, settings).ranges_m.at(200), kInfinity);
  EXPECT_NEAR(scan_in_dust(9.0, {}, settings).ranges_m.at(200), 9.0, 1e-3);
}

TEST(LidarSurfaces, DustGivesEchoesOfItsOwnByBeersLaw) {
  LidarSettings settings = ideal();
  settings.fov_deg = 4.0;
  settings.beams = 20000;
  settings.rate_hz = 10.0;
  const DustSettings dust{.enabled = true, .visibility_m = 20.0, .backscatter_probability = 0.1};
  const LaserScan scan = scan_in_dust(5.0, dust, settings);
  int echoes = 0;
  for (const float range : scan.ranges_m) echoes += range < 4.99f;
  const double expected =
      1.0 - std::exp(-0.1 * std::log(50.0) / 20.0 * 5.0);  // 9.3 %; those in the last centimetre look right
  EXPECT_NEAR(echoes / 20000.0, expected * (1.0 - 0.01 / 5.0), 4.0 * std::sqrt(expected / 20000.0));
}

/// The edge of a plate at `near_m` in front of a wall at `far_m`; the plate fills the beams left of 0.
std::string edge(double near_m, double far_m) {
  return box(std::to_string(near_m + 0.01) + " 2 0", "0.01 2 5") +
         box(std::to_string(far_m + 0.5) + " 0 0", "0.5 20 5");
}

/// Ranges of a scan across that edge with beams 0.1 degrees apart.
std::vector<float> across_the_edge(const SmallWorld& world, double width_deg, double turn_deg) {
  LidarSettings settings = ideal();
  settings.fov_deg = 4.0;
  settings.beams = 40;
  settings.beam_width_deg = width_deg;
  const Pose3 pose{Eigen::Vector3d::Zero(), quaternion_from_yaw(turn_deg * kDegree)};
  return scans_along(world, settings, 0.11, [&](double) { return pose; }).front().ranges_m;
}

TEST(LidarSurfaces, AtAnEdgeABeamHalfAsWideAgainAsItsStepReturnsAMixtureOfBothRanges) {
  const SmallWorld world(edge(3.0, 4.0));
  // Beam 20 looks 0.02 degrees left of the edge, on the plate: of its 0.15 degrees 0.095 lie there, three
  // rays of four.
  const std::vector<float> ranges = across_the_edge(world, 0.15, 0.02);
  EXPECT_NEAR(ranges.at(19), 4.0, 2e-3);
  const double near_light = 3.0 / 9.0, far_light = 1.0 / 16.0;  // rays over range squared
  EXPECT_NEAR(ranges.at(20), (3.0 * near_light + 4.0 * far_light) / (near_light + far_light), 2e-3);
  EXPECT_NEAR(ranges.at(21), 3.0, 2e-3);
  for (std::size_t beam = 0; beam < 19; ++beam) EXPECT_NEAR(ranges[beam], 4.0, 5e-3) << beam;
  for (std::size_t beam = 22; beam < ranges.size(); ++beam) EXPECT_NEAR(ranges[beam], 3.0, 5e-3) << beam;
}

TEST(LidarSurfaces, WithoutWidthOrOverAGapOf2MetresNoPixelIsMixed) {
  const SmallWorld near_wall(edge(3.0, 4.0)), far_wall(edge(3.0, 5.0));
  EXPECT_NEAR(across_the_edge(near_wall, 0.0, 0.02).at(20), 3.0, 2e-3);
  EXPECT_NEAR(across_the_edge(far_wall, 0.15, 0.02).at(20), 3.0, 2e-3);
}

}  // namespace
}  // namespace patrol::sim::lidar_surfaces_test
