#include "stack/localization/site_registrar.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"

namespace patrol::stack::site_registrar_test {
namespace {

constexpr double kSpeed_mps = 0.5;
const SiteFrame kSite{.T_site_start = {11.0, 8.0, to_rad(90.0)},
                      .datum = GeodeticDatum{.latitude_deg = 29.21, .longitude_deg = 119.46}};

double square(double value) { return value * value; }

GnssFix fix_at(const Eigen::Vector2d& p_site, Time stamp) {
  const GeodeticPosition position = to_geodetic(*kSite.datum, p_site);
  return {.stamp = stamp,
          .status = GnssStatus::kFix,
          .latitude_deg = position.latitude_deg,
          .longitude_deg = position.longitude_deg,
          .altitude_m = 0.0,
          .position_std_m = Eigen::Vector3d(0.01, 0.01, 0.02)};
}

/// Drives straight ahead for so many meters; the map is what `T_map_true` makes of the path. A scan every meter.
std::vector<Pose2> drive(SiteRegistrar& registrar, const Pose2& T_site_map, int meters, double map_scale = 1.0) {
  std::vector<Pose2> path;
  for (int i = 0; i <= meters; ++i) {
    const Pose2 T_true{1.0 * i, 0.0, 0.0}, T_map_body{map_scale * i, 0.0, 0.0};
    path.push_back(T_map_body);
    const PoseFromScan pose{.scan = static_cast<std::size_t>(i), .T_scan_body = {}, .T_map_body = T_map_body};
    const GnssFix fix = fix_at(T_site_map * T_true.position(), from_seconds(i / kSpeed_mps));
    if (const auto position = registrar.position_of(fix, Eigen::Vector2d::Zero())) registrar.add(*position, pose);
  }
  return path;
}

TEST(SiteRegistrar, BeginsWithTheSurveyedStart) {
  SiteRegistrar registrar({}, kSite);
  const std::optional<SiteRegistration> first = registrar.update(from_seconds(1.0), {});
  ASSERT_TRUE(first);
  EXPECT_THAT(first->T_site_map, test::Pose2Near(kSite.T_site_start, 1e-12, 1e-12));
  EXPECT_FALSE(registrar.is_due(from_seconds(1.5)));
  EXPECT_FALSE(registrar.update(from_seconds(2.0), {}));  // nothing has changed
}

TEST(SiteRegistrar, FindsThePutDownYawFromFixes) {
  SiteRegistrar registrar({}, kSite);
  const Pose2 T_site_map = kSite.T_site_start * Pose2{0.01, -0.01, to_rad(0.5)};
  const std::vector<Pose2> path = drive(registrar, T_site_map, 60);
  const std::optional<SiteRegistration> found = registrar.update(from_seconds(200.0), path);
  ASSERT_TRUE(found);
  EXPECT_LT(std::abs(wrap_angle(found->T_site_map.yaw - T_site_map.yaw)), to_rad(0.02));
  EXPECT_LT(std::sqrt(found->covariance(2, 2)), to_rad(0.1));
}

// A loop closure turns the map by one degree: the fixes follow their scans.
TEST(SiteRegistrar, FollowsTheMapWhenItIsCorrected) {
  SiteRegistrar registrar({}, kSite);
  std::vector<Pose2> path = drive(registrar, kSite.T_site_start, 60);
  registrar.update(from_seconds(200.0), path);
  const Pose2 correction{0.0, 0.0, to_rad(-1.0)};
  for (Pose2& pose : path) pose = correction * pose;
  const std::optional<SiteRegistration> corrected = registrar.update(from_seconds(201.0), path);
  ASSERT_TRUE(corrected);
  EXPECT_NEAR(wrap_angle(corrected->T_site_map.yaw - kSite.T_site_start.yaw), to_rad(1.0), to_rad(0.05));
}

TEST(SiteRegistrar, WithoutADatumIgnoresFixes) {
  SiteRegistrar registrar({}, {.T_site_start = kSite.T_site_start, .datum = {}});
  EXPECT_FALSE(registrar.uses_gnss());
  const std::vector<Pose2> path = drive(registrar, kSite.T_site_start * Pose2{5.0, 0.0, 0.0}, 60);
  EXPECT_THAT(registrar.update(from_seconds(200.0), path)->T_site_map,
              test::Pose2Near(kSite.T_site_start, 1e-12, 1e-12));
}

constexpr int kNumAnchors = 9;

/// Anchors on alternating sides of a tunnel along x of site, every 20 m.
UwbAnchor tunnel_anchor(int number) {
  return {.number = number, .p_m = {20.0 * number - 14.0, number % 2 == 0 ? -5.3 : 5.3, 2.5}};
}

/// Drives 160 m through the tunnel with ranges of the given bias and delay; returns the path in map.
std::vector<Pose2> drive_through_tunnel(SiteRegistrar& registrar, const Pose2& T_site_map, const UwbCalibration& uwb,
                                        double delay_m) {
  const Eigen::Vector3d p_level_antenna(0.1, 0.0, 0.5);
  std::vector<Pose2> path;
  for (int i = 0; i <= 160; ++i) {
    const Pose2 T_map_body{1.0 * i, 0.0, 0.0};
    path.push_back(T_map_body);
    for (int number = 1; number <= kNumAnchors; ++number) {
      const UwbAnchor anchor = tunnel_anchor(number);
      const double range_m = predict_uwb_range(anchor, T_site_map * T_map_body, p_level_antenna, uwb).range_m;
      if (range_m > 40.0) continue;
      registrar.add(UwbRange{.stamp = from_seconds(i + 0.1 * number),
                             .anchor = number,
                             .range_m = range_m + delay_m * (number % 4 - 1.5)},
                    anchor, {.scan = static_cast<std::size_t>(i), .T_scan_body = {}, .T_map_body = T_map_body},
                    p_level_antenna);
    }
  }
  return path;
}

TEST(SiteRegistrar, FindsThePutDownYawFromRangesWithAntennaDelays) {
  const SiteFrame site{.T_site_start = {3.0, -2.0, 0.0}, .datum = {}};
  SiteRegistrar registrar({}, site);
  const Pose2 T_site_map = site.T_site_start * Pose2{0.01, -0.01, to_rad(0.5)};
  const std::vector<Pose2> path = drive_through_tunnel(registrar, T_site_map, {}, 0.05);
  const std::optional<SiteRegistration> found = registrar.update(from_seconds(200.0), path);
  ASSERT_TRUE(found);
  EXPECT_LT(std::abs(wrap_angle(found->T_site_map.yaw - T_site_map.yaw)), to_rad(0.05));
  EXPECT_LT(std::sqrt(found->covariance(2, 2)), to_rad(0.1));
}

// The robot drives 3 m toward the post: one detection every 0.5 m, with the errors of 1 mm and 0.05 degrees.
TEST(SiteRegistrar, FindsThePutDownErrorFromTheChargingPost) {
  const SiteFrame site{.T_site_start = {3.0, -2.0, 0.0}, .datum = {}};
  const Pose2 T_site_map = site.T_site_start * Pose2{0.3, -0.2, to_rad(1.0)}, T_site_docked{7.0, -2.0, 0.1};
  const auto found_with = [&](const localize::RegistrationSettings& settings) {
    SiteRegistrar registrar(settings, site);
    std::vector<Pose2> path;
    for (int i = 0; i <= 30; ++i) {
      const Pose2 T_map_body{0.1 * i, 0.0, 0.0};
      path.push_back(T_map_body);
      DockDetection detection{.stamp = from_seconds(i),
                              .T_level_docked = (T_site_map * T_map_body).inverse() * T_site_docked};
      detection.covariance = Eigen::Vector3d(1e-6, 1e-6, square(to_rad(0.05))).asDiagonal();
      registrar.add(detection, T_site_docked,
                    {.scan = static_cast<std::size_t>(i), .T_scan_body = {}, .T_map_body = T_map_body});
    }
    EXPECT_LE(registrar.num_measurements(), 7U);
    return registrar.update(from_seconds(60.0), path);
  };
  const localize::RegistrationSettings put_down_by_eye{.start_position_std_m = 0.5, .start_yaw_std_deg = 5.0};
  localize::RegistrationSettings without_dock = put_down_by_eye;
  without_dock.use_dock = false;
  const std::optional<SiteRegistration> found = found_with(put_down_by_eye), prior = found_with(without_dock);
  ASSERT_TRUE(found && prior);
  EXPECT_THAT(prior->T_site_map, test::Pose2Near(site.T_site_start, 1e-12, 1e-12));
  const Eigen::Vector3d std = found->covariance.diagonal().cwiseSqrt();
  EXPECT_THAT(found->T_site_map, test::Pose2Near(T_site_map, 0.01, to_rad(0.2)));
  EXPECT_GT(std[2], to_rad(0.5));
  EXPECT_LT(std[2], to_rad(1.1));
  EXPECT_GT(std.head<2>().minCoeff(), 0.02);
  EXPECT_LT(std.head<2>().maxCoeff(), 0.08);
}

// A bias of 1 m from 10 m on moves the map by decimeters if it is not corrected. Its pose is searched with a wide
// prior.
TEST(SiteRegistrar, CorrectsTheBiasOfRangesByTheGivenCalibration) {
  const SiteFrame site{.T_site_start = {3.0, -2.0, 0.0}, .datum = {}};
  const UwbCalibration uwb{.distance_m = {6.0, 10.0}, .bias_m = {0.0, 1.0}};
  localize::RegistrationSettings settings;
  settings.start_position_std_m = 1.0;
  settings.start_yaw_std_deg = 2.0;
  const Pose2 T_site_map = site.T_site_start * Pose2{0.1, -0.2, to_rad(0.5)};
  const auto position_error_m = [&](const UwbCalibration& calibration) {
    SiteRegistrar registrar(settings, site, std::nullopt, calibration);
    const std::vector<Pose2> path = drive_through_tunnel(registrar, T_site_map, uwb, 0.0);
    return (registrar.update(from_seconds(200.0), path)->T_site_map.position() - T_site_map.position()).norm();
  };
  EXPECT_LT(position_error_m(uwb), 0.001);
  EXPECT_GT(position_error_m({}), 0.01);
}

TEST(SiteRegistrar, BoundsItsMeasurements) {
  localize::RegistrationSettings settings;
  settings.max_measurements = 20;
  SiteRegistrar registrar(settings, kSite);
  const Pose2 T_site_map = kSite.T_site_start * Pose2{0.0, 0.0, to_rad(0.5)};
  const std::vector<Pose2> path = drive(registrar, T_site_map, 300);
  EXPECT_LE(registrar.num_measurements(), 20U);
  EXPECT_LT(std::abs(wrap_angle(registrar.update(from_seconds(999.0), path)->T_site_map.yaw - T_site_map.yaw)),
            to_rad(0.05));
}

}  // namespace
}  // namespace patrol::stack::site_registrar_test
