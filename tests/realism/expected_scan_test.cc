#include "realism/expected_scan.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/realism/sites.h"

namespace patrol::realism {
namespace {

using test::box;
using test::kPi;

constexpr float kNone = std::numeric_limits<float>::infinity();

TEST(ExpectedBeams, InARoomAreItsRangeIncidenceAndSlopeInClosedForm) {
  const Site site = test::site_of(test::room());
  const PosedScan posed = test::posed_scan(360, 2.0 * kPi, {0.5, -0.25, 0.3});
  const std::vector<ExpectedBeam> beams = expected_beams(site, posed, {});
  ASSERT_EQ(beams.size(), 360u);
  std::size_t num_smooth = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double angle = posed.azimuth_rad(i) + 0.3;
    EXPECT_NEAR(beams[i].range_m, test::room_range_m(angle, 0.5, -0.25), 1e-6) << i;
    EXPECT_NEAR(beams[i].reflectivity, 0.5, 1e-6);
    if (!beams[i].is_smooth) continue;
    ++num_smooth;
    const double cosine = std::max(std::abs(std::cos(angle)), 0.0), sine = std::abs(std::sin(angle));
    const bool is_x_wall = std::abs(beams[i].normal.x()) > 0.5;
    EXPECT_NEAR(beams[i].cosine, is_x_wall ? cosine : sine, 1e-6) << i;
    const double tangent = is_x_wall ? std::tan(angle) : -1.0 / std::tan(angle);
    EXPECT_NEAR(beams[i].slope_m_per_rad, beams[i].range_m * tangent,
                0.002 * beams[i].range_m * (1.0 + tangent * tangent))
        << i;
  }
  EXPECT_GE(num_smooth, 340u);  // all but those at the four corners
  EXPECT_LE(num_smooth, 356u);
}

TEST(ExpectedBeams, OfAConeMeetTheWallsFartherByItsCosine) {
  constexpr double kCone_rad = 0.05;
  const Site site = test::site_of(test::room());
  PosedScan posed = test::posed_scan(360);
  const std::vector<ExpectedBeam> level = expected_beams(site, posed, {});
  posed.aim = sim::LidarAim({.cone_rad = kCone_rad});
  const std::vector<ExpectedBeam> raised = expected_beams(site, posed, {});
  for (std::size_t i = 0; i < level.size(); ++i)
    EXPECT_NEAR(raised[i].range_m, level[i].range_m / std::cos(kCone_rad), 1e-6) << i;
}

TEST(ExpectedBeams, ResidualsAreThePlantedBiasAndEachClassHasItsBeam) {
  // A wall at x = 4 m with glass in the middle of the upper half, and a post of 0.2 m before it: a jump of 0.5 m.
  const Site site =
      test::site_of(box("4.5 -5 0", "0.5 5 3") + "<geom pos=\"4.5 2 0\" size=\"0.5 2 3\" rgba=\"0.5 0.5 0.5 1\"/>" +
                    box("3.45 -1 0", "0.05 0.1 3"));
  PosedScan posed = test::posed_scan(180, kPi);
  const std::vector<ExpectedBeam> expected = expected_beams(site, posed, {});
  for (std::size_t i = 0; i < expected.size(); ++i)
    posed.scan.ranges_m[i] = expected[i].has_surface() ? static_cast<float>(expected[i].range_m + 0.02) : kNone;
  std::size_t middle = 0;  // a smooth beam without an edge near it
  for (std::size_t i = 5; i + 5 < expected.size(); ++i) {
    bool is_clear = true;
    for (std::size_t k = i - 5; k <= i + 5; ++k) is_clear = is_clear && expected[k].is_smooth;
    if (is_clear) middle = i;
  }
  ASSERT_GT(middle, 0u);
  posed.scan.ranges_m[0] = 12.0f;  // along -y: no wall there
  posed.scan.ranges_m[middle - 4] = kNone;
  posed.scan.ranges_m[middle - 2] -= 1.0f;                                           // isolated: a false return
  posed.scan.ranges_m[middle + 1] -= 1.5f, posed.scan.ranges_m[middle + 2] -= 1.5f;  // two: an object
  posed.scan.ranges_m[middle + 4] += 2.0f;
  posed.scan.ranges_m[middle + 5] = -kNone;
  const std::vector<Beam> beams = beams_of(posed, expected, posed.scan.ranges_m, 0, {});
  EXPECT_EQ(beams[0].kind, BeamClass::kUnexplained);
  EXPECT_EQ(beams[1].kind, BeamClass::kEmpty);
  EXPECT_EQ(beams[middle].kind, BeamClass::kStatic);
  EXPECT_NEAR(beams[middle].residual_m(), 0.02, 1e-6);
  EXPECT_EQ(beams[middle - 4].kind, BeamClass::kDropout);
  EXPECT_EQ(beams[middle - 2].kind, BeamClass::kShort);
  EXPECT_EQ(beams[middle + 1].kind, BeamClass::kMoving);
  EXPECT_EQ(beams[middle + 2].kind, BeamClass::kMoving);
  EXPECT_EQ(beams[middle + 4].kind, BeamClass::kFar);
  EXPECT_EQ(beams[middle + 5].kind, BeamClass::kNear);
  std::size_t num_jumps = 0;
  for (const Beam& beam : beams) {
    if (!beam.expected.is_jump) continue;
    ++num_jumps;
    EXPECT_EQ(beam.kind, BeamClass::kEdge);
  }
  EXPECT_EQ(num_jumps, 2u);  // onto the post and off it
}

TEST(ExpectedBeams, AChangeOfReflectivityOrOfTheNormalIsNoSmoothSurface) {
  const Site site = test::site_of(box("4.5 -2 0", "0.5 2 3") + box("4.5 2 0", "0.5 2 3", "0.1 0.1 0.1 1"));
  const std::vector<ExpectedBeam> beams = expected_beams(site, test::posed_scan(720, kPi / 2.0), {});
  EXPECT_FALSE(beams[360].is_smooth);  // at the seam
  EXPECT_FALSE(beams[360].is_jump);
  EXPECT_TRUE(beams[340].is_smooth);
  EXPECT_NEAR(beams[340].reflectivity, 0.5, 1e-6);
  EXPECT_TRUE(beams[380].is_smooth);
  EXPECT_NEAR(beams[380].reflectivity, 0.1, 1e-6);
}

TEST(ExpectedBeams, SurfacesNarrowerThanTheMarginInMetersAreNotSmooth) {
  // A post of 8 cm at 2 m: 0.6 degrees are 2 cm there. A wall 3 m behind it: both steps of the range exceed mixed
  // pixels.
  const Site site = test::site_of(box("2.04 0 0", "0.04 0.04 3") + box("5.5 0 0", "0.5 6 3"));
  const PosedScan posed = test::posed_scan(721, kPi / 2.0);
  const std::vector<ExpectedBeam> by_default = expected_beams(site, posed, {});
  const std::vector<ExpectedBeam> by_angle = expected_beams(site, posed, {.margin_m = 0.0});
  EXPECT_NEAR(by_angle[360].range_m, 2.0, 1e-3);
  EXPECT_TRUE(by_angle[360].is_smooth);
  EXPECT_FALSE(by_default[360].is_smooth);
  EXPECT_NEAR(by_default[360].slope_m_per_rad, by_angle[360].slope_m_per_rad, 1e-9);
  EXPECT_TRUE(by_default[500].is_smooth);  // on the wall
  const std::vector<ExpectedBeam> wide = expected_beams(site, posed, {.margin_m = 0.03});
  EXPECT_TRUE(wide[360].is_smooth);
}

TEST(ExpectedBeams, TheMarginInMetersMakesNoJumps) {
  // A wall at 80 degrees of incidence ends at x = 4 m: the ranges of beams on it are up to 0.2 m apart.
  const Site site = test::site_of(box("2 0.6 0", "2 0.1 3") + box("6.5 0 0", "0.5 6 3"));
  const PosedScan posed = test::posed_scan(180, kPi);
  const std::vector<ExpectedBeam> by_default = expected_beams(site, posed, {});
  const std::vector<ExpectedBeam> by_angle = expected_beams(site, posed, {.margin_m = 0.0});
  std::size_t num_narrow = 0;
  for (std::size_t i = 0; i < by_default.size(); ++i) {
    EXPECT_EQ(by_default[i].is_jump, by_angle[i].is_jump) << i;
    if (by_angle[i].is_smooth && !by_default[i].is_smooth) ++num_narrow;
  }
  EXPECT_GT(num_narrow, 0u);
}

TEST(PlaceScan, BeamsHaveThePoseOfTheirOwnInstant) {
  const Trajectory path = {{from_seconds(0.0), to_pose3({0.0, 0.0, 0.0})},
                           {from_seconds(1.0), to_pose3({2.0, 0.0, 1.0})}};
  LaserScan scan = test::posed_scan(101).scan;
  scan.stamp = from_seconds(0.2);
  scan.time_increment_s = 0.001;
  PosedScan posed;
  ASSERT_TRUE(place_scan(scan, path, to_pose3({0.1, 0.0, 0.0}), posed));
  for (const std::size_t beam : {std::size_t{0}, std::size_t{37}, std::size_t{100}}) {
    const double at = 0.2 + 0.001 * static_cast<double>(beam);
    const Pose2 pose = to_pose2(posed.pose_of(beam));
    EXPECT_NEAR(pose.yaw, at, 1e-6);
    EXPECT_NEAR(pose.x, 2.0 * at + 0.1 * std::cos(at), 1e-4);
    EXPECT_NEAR(pose.y, 0.1 * std::sin(at), 1e-4);
  }
  scan.stamp = from_seconds(0.95);
  EXPECT_FALSE(place_scan(scan, path, {}, posed));  // ends after the path
  scan.time_increment_s = 0.0;
  ASSERT_TRUE(place_scan(scan, path, {}, posed));
  EXPECT_EQ(posed.T_site_lidar.size(), 1u);
}

}  // namespace
}  // namespace patrol::realism
