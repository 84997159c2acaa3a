#include "localize/amcl/trust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "localize/amcl/fit_monitor.h"

namespace patrol::localize::amcl_trust_test {
namespace {

/// Deviation `weak_m` along `direction_rad`, 1 cm across.
BeliefEvidence evidence(double weak_m, double direction_rad = 0.0) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(direction_rad).toRotationMatrix();
  BeliefEvidence evidence{.clump_weight = 1.0, .scan_fit = 1.0};
  evidence.covariance.topLeftCorner<2, 2>() = R * Eigen::Vector2d(weak_m * weak_m, 1e-4).asDiagonal() * R.transpose();
  return evidence;
}

double trust_of(const BeliefEvidence& evidence) { return assess_trust({}, evidence, false, {}).trust; }

TEST(Trust, IsOneToFiveCentimetresHalfAtTwentyFiveAndNothingAtOneMetre) {
  EXPECT_NEAR(trust_of(evidence(0.03)), 1.0, 1e-9);
  EXPECT_NEAR(trust_of(evidence(0.05)), 1.0, 1e-9);
  EXPECT_NEAR(trust_of(evidence(0.15)), 0.75, 1e-9);
  EXPECT_NEAR(trust_of(evidence(0.25)), 0.5, 1e-9);
  EXPECT_NEAR(trust_of(evidence(0.625)), 0.25, 1e-9);
  EXPECT_NEAR(trust_of(evidence(2.0)), 0.0, 1e-9);
}

TEST(Trust, NamesTheWeakestDirectionAndItsDeviation) {
  for (const double direction : {-1.2, 0.0, 0.5}) {
    const LocalizationTrust trust = assess_trust({}, evidence(0.4, direction), false, {});
    EXPECT_NEAR(trust.weak_direction_rad, direction, 1e-9);
    EXPECT_NEAR(trust.weak_std_m, 0.4, 1e-9);
  }
}

TEST(Trust, FallsWithEveryDoubt) {
  BeliefEvidence two_places = evidence(0.03), bad_scan = evidence(0.03), bad_ranges = evidence(0.03);
  two_places.clump_weight = 0.5, bad_scan.scan_fit = 0.3, bad_ranges.range_fit = 0.0;
  for (const BeliefEvidence& doubtful : {two_places, bad_scan, bad_ranges}) {
    EXPECT_EQ(trust_of(doubtful), 0.0);
    EXPECT_TRUE(assess_trust({}, doubtful, false, {}).is_lost);
  }
}

TEST(Trust, WhoWasLostIsFoundOnlyWhenOnePlaceIsLeft) {
  BeliefEvidence nearly = evidence(0.03);
  nearly.clump_weight = 0.9;
  EXPECT_TRUE(assess_trust({}, nearly, true, {}).is_lost);
  EXPECT_FALSE(assess_trust({}, nearly, false, {}).is_lost);
  EXPECT_FALSE(assess_trust({}, evidence(0.03), true, {}).is_lost);
}

TEST(Trust, OfACovarianceThatIsNotANumberIsLost) {
  BeliefEvidence broken = evidence(0.03);
  broken.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(assess_trust({}, broken, false, {}).is_lost);
}

TEST(FitMonitor, InjectsNothingWhileAllIsAsItWas) {
  FitMonitor monitor({});
  for (int i = 0; i < 100; ++i) monitor.add_scan_likelihood(i % 2 == 0 ? 0.7 : 0.9), monitor.add_scan_fit(0.9), monitor.add_range(0.6);
  EXPECT_EQ(monitor.injection_share(), 0.0);
  EXPECT_EQ(monitor.range_trust(), 1.0);
}

// The short average is at 0.8^n of the step after n scans: at 0.2 + 0.7 * 0.8^5 = 0.43 after five; the long one at 0.83.
TEST(FitMonitor, InjectsWhenTheScanSuddenlyFitsLess) {
  FitMonitor monitor({});
  for (int i = 0; i < 50; ++i) monitor.add_scan_likelihood(0.9);
  for (int i = 0; i < 5; ++i) monitor.add_scan_likelihood(0.2);
  EXPECT_NEAR(monitor.injection_share(), 1.0 - 1.5 * (0.2 + 0.7 * std::pow(0.8, 5)) / (0.2 + 0.7 * std::pow(0.98, 5)), 1e-9);
}

TEST(FitMonitor, ABadFitIsNotForgottenHoweverLongItLasts) {
  FitMonitor monitor({});
  for (int i = 0; i < 2000; ++i) monitor.add_scan_likelihood(0.2), monitor.add_scan_fit(0.1);
  EXPECT_EQ(monitor.injection_share(), 0.5);
}

TEST(FitMonitor, RangesThatDoNotFitAreEnough) {
  FitMonitor monitor({});
  for (int i = 0; i < 30; ++i) monitor.add_scan_likelihood(0.9), monitor.add_scan_fit(1.0), monitor.add_range(0.02);
  EXPECT_GT(monitor.injection_share(), 0.4);
  EXPECT_LT(monitor.range_trust(), 0.6);
  monitor.reset();
  EXPECT_EQ(monitor.injection_share(), 0.0);
}

}  // namespace
}  // namespace patrol::localize::amcl_trust_test
