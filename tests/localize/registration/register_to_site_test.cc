#include "localize/registration/register_to_site.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::localize::register_to_site_test {
namespace {

const Pose2 kStart{11.0, 8.0, 1.5};
const Eigen::Vector2d kLever(0.1, -0.05);
constexpr double kCorrelation_s = 20.0;

/// The true registration: the prior's mean moved by the put-down error.
Pose2 true_registration(const Eigen::Vector3d& error) {
  return {kStart.x + error.x(), kStart.y + error.y(), kStart.yaw + error.z()};
}

/// An L of 40 m and 20 m at 0.7 m/s, a pose every meter.
std::vector<Pose2> corner_path() {
  std::vector<Pose2> path;
  for (int i = 0; i < 40; ++i) path.push_back({1.0 * i, 0.0, 0.0});
  for (int i = 0; i < 20; ++i) path.push_back({40.0, 1.0 * i, kDegree * 90.0});
  return path;
}

/// Fixes along a path with given errors of the position.
template <typename ErrorOf>
std::vector<SiteMeasurement> fixes_along(const std::vector<Pose2>& path, const Pose2& T_site_map, double std_m,
                                         const ErrorOf& error_of) {
  std::vector<SiteMeasurement> fixes;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d p_site = T_site_map * (path[i] * kLever);
    fixes.push_back({.stamp = from_seconds(static_cast<double>(i) / 0.7),
                     .source = 0,
                     .correlation_time_s = kCorrelation_s,
                     .T_map_body = path[i],
                     .content = AntennaPosition{.p_level_antenna = kLever,
                                                .p_site_antenna = p_site + Eigen::Vector2d(error_of(i)),
                                                .std_m = std_m}});
  }
  return fixes;
}

Eigen::Vector2d no_error(std::size_t) { return Eigen::Vector2d::Zero(); }

RegistrationSettings without_map_error() {
  RegistrationSettings settings;
  settings.map_std_m = 0.0;
  return settings;
}

RegistrationSettings without_prior() {
  RegistrationSettings settings = without_map_error();
  settings.start_position_std_m = settings.start_yaw_std_deg = 1e6;
  return settings;
}

SitePoseGaussian solve(const std::vector<SiteMeasurement>& measurements, const RegistrationSettings& settings) {
  return register_to_site(registration_prior(kStart, settings), measurements, settings);
}

TEST(RegisterToSite, WithoutMeasurementsIsThePrior) {
  const RegistrationSettings settings;
  const SitePoseGaussian estimate = solve({}, settings);
  EXPECT_THAT(estimate.T_site_map, test::Pose2Near(kStart, 1e-12, 1e-12));
  EXPECT_NEAR(estimate.covariance(0, 0), 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(std::sqrt(estimate.covariance(2, 2)), to_rad(settings.start_yaw_std_deg), 1e-9);
}

TEST(RegisterToSite, PerfectFixesGiveTheTransform) {
  const Pose2 truth = true_registration({3.0, -2.0, 0.4});
  const SitePoseGaussian estimate = solve(fixes_along(corner_path(), truth, 0.01, no_error), without_prior());
  EXPECT_THAT(estimate.T_site_map, test::Pose2Near(truth, 1e-9, 1e-9));
}

TEST(RegisterToSite, FixesAtOnePlaceKnowNoYaw) {
  const Pose2 truth = true_registration({0.05, 0.0, to_rad(0.5)});
  const std::vector<Pose2> standing(60, Pose2{});
  const RegistrationSettings settings = without_map_error();
  const SitePoseGaussian estimate = solve(fixes_along(standing, truth, 0.01, no_error), settings);
  const double prior_rad = to_rad(settings.start_yaw_std_deg);
  EXPECT_NEAR(std::sqrt(estimate.covariance(2, 2)), prior_rad, 0.01 * prior_rad);
  EXPECT_NEAR(estimate.T_site_map.yaw, kStart.yaw, to_rad(0.1));  // the lever arm of 0.1 m turns it a little
  EXPECT_LT(estimate.covariance(0, 0), 0.01 * 0.01);
}

/// First-order Gauss-Markov errors of the fixes of one draw.
std::vector<Eigen::Vector2d> correlated_errors(std::size_t count, double std_m, std::uint64_t draw) {
  const RandomStream noise(draw, "test/fix");
  const double phi = std::exp(-1.0 / 0.7 / kCorrelation_s);
  std::vector<Eigen::Vector2d> errors;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d white(noise.normal(i, 0), noise.normal(i, 1));
    errors.emplace_back(i == 0 ? Eigen::Vector2d(std_m * white)
                               : Eigen::Vector2d(phi * errors.back() + std_m * std::sqrt(1.0 - phi * phi) * white));
  }
  return errors;
}

/// Mean normalized squared error over draws of the put-down error and of the fixes' errors.
double mean_nees(bool models_correlation) {
  constexpr int kDraws = 300;
  const RegistrationSettings settings = without_map_error();
  const SitePoseGaussian prior = registration_prior(kStart, settings);
  double sum = 0.0;
  for (std::uint64_t draw = 1; draw <= kDraws; ++draw) {
    const RandomStream put_down(draw, "test/put_down");
    const Eigen::Vector3d error(0.02 * put_down.normal(0), 0.02 * put_down.normal(1),
                                to_rad(settings.start_yaw_std_deg) * put_down.normal(2));
    const Pose2 truth = true_registration(error);
    const std::vector<Eigen::Vector2d> errors = correlated_errors(corner_path().size(), 0.01, draw);
    std::vector<SiteMeasurement> fixes =
        fixes_along(corner_path(), truth, 0.01, [&](std::size_t i) { return errors[i]; });
    if (!models_correlation) {
      for (SiteMeasurement& fix : fixes) fix.correlation_time_s = 0.0;
    }
    const SitePoseGaussian estimate = register_to_site(prior, fixes, settings);
    const Eigen::Vector3d e(estimate.T_site_map.x - truth.x, estimate.T_site_map.y - truth.y,
                            wrap_angle(estimate.T_site_map.yaw - truth.yaw));
    sum += e.dot(solve_symmetric(estimate.covariance, e));
  }
  return sum / kDraws;
}

// The mean of 300 draws of a chi-square of three degrees has a standard deviation of 0.14.
TEST(RegisterToSite, CovarianceIsConsistentWithCorrelatedFixes) {
  const double nees = mean_nees(true);
  EXPECT_GT(nees, 2.4);
  EXPECT_LT(nees, 3.4);
}

TEST(RegisterToSite, FixesTakenAsIndependentWouldBeOverconfident) { EXPECT_GT(mean_nees(false), 6.0); }

// Every third solution is a float one, three to six meters off with a standard deviation of 0.4 m.
TEST(RegisterToSite, WrongFloatSolutionsDoNotMoveIt) {
  const RegistrationSettings settings = without_map_error();
  const Pose2 truth = true_registration({0.03, -0.02, to_rad(1.0)});
  std::vector<SiteMeasurement> fixes = fixes_along(corner_path(), truth, 0.01, no_error);
  const Pose2 without = solve(fixes, settings).T_site_map;
  for (std::size_t i = 0; i < fixes.size(); i += 3) {
    auto& position = std::get<AntennaPosition>(fixes[i].content);
    position.std_m = 0.4;
    position.p_site_antenna += Eigen::Vector2d(3.0, i % 2 == 0 ? 3.0 : -5.0);
    fixes[i].source = 1;
  }
  EXPECT_THAT(solve(fixes, settings).T_site_map, test::Pose2Near(without, 0.005, to_rad(0.02)));
}

// A put-down error of five standard deviations puts the far fixes 2 m from where the prior expects them.
TEST(RegisterToSite, AWrongPriorDoesNotMakeFixesOutliers) {
  RegistrationSettings settings = without_map_error();
  const Pose2 truth = true_registration({0.1, 0.1, to_rad(3.0)});
  std::vector<SiteMeasurement> fixes = fixes_along(corner_path(), truth, 0.01, no_error);
  fixes.erase(fixes.begin(), fixes.begin() + 20);  // the sky opens after 20 m
  EXPECT_LT(std::abs(wrap_angle(solve(fixes, settings).T_site_map.yaw - truth.yaw)), to_rad(0.15));
}

/// Ranges along the corner to four anchors about it, with the calibration's bias and given errors.
template <typename ErrorOf>
std::vector<SiteMeasurement> ranges_along_corner(const Pose2& T_site_map, const ErrorOf& error_of) {
  std::vector<SiteMeasurement> ranges;
  int stamp = 0;
  for (const Pose2& T_map_body : corner_path()) {
    for (int number = 0; number < 4; ++number, ++stamp) {
      const UwbAnchor anchor{.number = number, .p_m = {11.0 + 12.0 * (number % 2), 8.0 + 30.0 * (number / 2), 2.0}};
      const Eigen::Vector3d p_level_antenna(0.1, 0.0, 0.4);
      const double range_m = predict_uwb_range(anchor, T_site_map * T_map_body, p_level_antenna, {}).range_m;
      ranges.push_back({.stamp = from_seconds(0.1 * stamp),
                        .source = 10 + number,
                        .correlation_time_s = 0.0,
                        .T_map_body = T_map_body,
                        .content = AnchorRange{.anchor_in_site = anchor,
                                               .p_level_antenna = p_level_antenna,
                                               .range_m = range_m + error_of(number, stamp),
                                               .std_m = 0.1}});
    }
  }
  return ranges;
}

TEST(RegisterToSite, RangesToAnchorsGiveTheTransform) {
  const Pose2 truth = true_registration({0.3, -0.2, to_rad(2.0)});
  const std::vector<SiteMeasurement> ranges = ranges_along_corner(truth, [](int, int) { return 0.0; });
  EXPECT_THAT(solve(ranges, without_prior()).T_site_map, test::Pose2Near(truth, 1e-9, 1e-9));
}

// Antenna delays of 10 cm are constant errors of the ranges to one anchor. Taken for noise they would be averaged over
// 60 ranges to an anchor, and the claimed variance would be far too small. The mean of 200 draws of a chi-square of
// three degrees has a standard deviation of 0.17.
TEST(RegisterToSite, CovarianceIsConsistentWithAntennaDelays) {
  const auto mean_nees = [](const RegistrationSettings& settings) {
    constexpr int kDraws = 200;
    double sum = 0.0;
    for (std::uint64_t draw = 1; draw <= kDraws; ++draw) {
      const RandomStream noise(draw, "test/ranges"), delays(draw, "test/delays"), put_down(draw, "test/put_down");
      const Pose2 truth = true_registration({0.02 * put_down.normal(0), 0.02 * put_down.normal(1),
                                             to_rad(settings.start_yaw_std_deg) * put_down.normal(2)});
      const auto error_of = [&](int anchor, int stamp) {
        return 0.1 * delays.normal(static_cast<std::uint64_t>(anchor)) +
               0.1 * noise.normal(static_cast<std::uint64_t>(stamp));
      };
      const SitePoseGaussian estimate = solve(ranges_along_corner(truth, error_of), settings);
      const Eigen::Vector3d e(estimate.T_site_map.x - truth.x, estimate.T_site_map.y - truth.y,
                              wrap_angle(estimate.T_site_map.yaw - truth.yaw));
      sum += e.dot(solve_symmetric(estimate.covariance, e)) / kDraws;
    }
    return sum;
  };
  RegistrationSettings settings = without_map_error();
  const double modeled = mean_nees(settings);
  EXPECT_GT(modeled, 2.3);
  EXPECT_LT(modeled, 3.7);
  settings.anchor_delay_std_m = 1e-6;
  EXPECT_GT(mean_nees(settings), 6.0);
}

TEST(RegisterToSite, ASurveyedPoseGivesTheTransform) {
  const Pose2 truth = true_registration({0.3, -0.2, to_rad(2.0)}), T_map_body{2.0, -1.0, 0.3};
  const std::vector<SiteMeasurement> docked = {
      {.T_map_body = T_map_body,
       .content = SurveyedPose{.T_site_body = truth * T_map_body, .position_std_m = 0.01, .yaw_std_rad = to_rad(0.2)}}};
  const SitePoseGaussian estimate = solve(docked, without_prior());
  EXPECT_THAT(estimate.T_site_map, test::Pose2Near(truth, 1e-9, 1e-9));
  EXPECT_NEAR(std::sqrt(estimate.covariance(2, 2)), to_rad(0.2), 1e-6);
}

// The map is bent by 10 cm: its residuals are ten times the errors of the fixes.
TEST(RegisterToSite, ResidualsBeyondTheirExpectationWidenTheCovariance) {
  const RegistrationSettings settings = without_map_error();
  const auto bend = [](std::size_t i) { return Eigen::Vector2d(0.0, 0.1 * std::sin(0.3 * static_cast<double>(i))); };
  const auto straight = solve(fixes_along(corner_path(), kStart, 0.01, no_error), settings);
  const auto bent = solve(fixes_along(corner_path(), kStart, 0.01, bend), settings);
  EXPECT_GT(bent.covariance(1, 1), 2.0 * straight.covariance(1, 1));
}

}  // namespace
}  // namespace patrol::localize::register_to_site_test
