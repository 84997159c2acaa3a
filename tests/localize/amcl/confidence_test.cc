#include "localize/amcl/confidence.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "localize/amcl/divergence_monitor.h"

namespace patrol::localize::confidence_test {
namespace {

/// Deviation `weak_m` along `direction_rad`, 1 cm across.
LocalizationEvidence evidence(double weak_m, double direction_rad = 0.0) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(direction_rad).toRotationMatrix();
  LocalizationEvidence evidence{.cluster_weight = 1.0, .scan_fit = 1.0};
  evidence.covariance.topLeftCorner<2, 2>() = R * Eigen::Vector2d(weak_m * weak_m, 1e-4).asDiagonal() * R.transpose();
  return evidence;
}

double confidence_of(const LocalizationEvidence& evidence) {
  return assess_confidence({}, evidence, false, {}).confidence;
}

TEST(AssessConfidence, IsOneToFiveCentimetersHalfAtTwentyFiveAndNothingAtOneMeter) {
  EXPECT_NEAR(confidence_of(evidence(0.03)), 1.0, 1e-9);
  EXPECT_NEAR(confidence_of(evidence(0.05)), 1.0, 1e-9);
  EXPECT_NEAR(confidence_of(evidence(0.15)), 0.75, 1e-9);
  EXPECT_NEAR(confidence_of(evidence(0.25)), 0.5, 1e-9);
  EXPECT_NEAR(confidence_of(evidence(0.625)), 0.25, 1e-9);
  EXPECT_NEAR(confidence_of(evidence(2.0)), 0.0, 1e-9);
}

TEST(AssessConfidence, NamesTheWeakestDirectionAndItsDeviation) {
  for (const double direction : {-1.2, 0.0, 0.5}) {
    const LocalizationConfidence confidence = assess_confidence({}, evidence(0.4, direction), false, {});
    EXPECT_NEAR(confidence.max_std_direction_rad, direction, 1e-9);
    EXPECT_NEAR(confidence.max_std_m, 0.4, 1e-9);
  }
}

TEST(AssessConfidence, FallsWithEachIndicator) {
  LocalizationEvidence two_places = evidence(0.03), bad_scan = evidence(0.03), bad_ranges = evidence(0.03);
  two_places.cluster_weight = 0.5, bad_scan.scan_fit = 0.3, bad_ranges.range_fit = 0.0;
  for (const LocalizationEvidence& doubtful : {two_places, bad_scan, bad_ranges}) {
    EXPECT_EQ(confidence_of(doubtful), 0.0);
    EXPECT_TRUE(assess_confidence({}, doubtful, false, {}).is_lost);
  }
}

TEST(AssessConfidence, RecoversFromLostOnlyWithOneClusterLeft) {
  LocalizationEvidence nearly = evidence(0.03);
  nearly.cluster_weight = 0.9;
  EXPECT_TRUE(assess_confidence({}, nearly, true, {}).is_lost);
  EXPECT_FALSE(assess_confidence({}, nearly, false, {}).is_lost);
  EXPECT_FALSE(assess_confidence({}, evidence(0.03), true, {}).is_lost);
}

TEST(AssessConfidence, OfACovarianceThatIsNotANumberIsLost) {
  LocalizationEvidence broken = evidence(0.03);
  broken.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(assess_confidence({}, broken, false, {}).is_lost);
}

TEST(DivergenceMonitor, InjectsNothingWhileAllIsAsItWas) {
  DivergenceMonitor monitor({});
  for (int i = 0; i < 100; ++i)
    monitor.add_scan_likelihood(i % 2 == 0 ? 0.7 : 0.9), monitor.add_scan_fit(0.9), monitor.add_range(0.6);
  EXPECT_EQ(monitor.injection_fraction(), 0.0);
  EXPECT_EQ(monitor.range_confidence(), 1.0);
}

// The short average is at 0.8^n of the step after n scans: at 0.2 + 0.7 * 0.8^5 = 0.43 after five; the long one at
// 0.83.
TEST(DivergenceMonitor, InjectsWhenTheScanSuddenlyFitsLess) {
  DivergenceMonitor monitor({});
  for (int i = 0; i < 50; ++i) monitor.add_scan_likelihood(0.9);
  for (int i = 0; i < 5; ++i) monitor.add_scan_likelihood(0.2);
  EXPECT_NEAR(monitor.injection_fraction(),
              1.0 - 1.5 * (0.2 + 0.7 * std::pow(0.8, 5)) / (0.2 + 0.7 * std::pow(0.98, 5)), 1e-9);
}

TEST(DivergenceMonitor, ABadFitIsNotForgottenHoweverLongItLasts) {
  DivergenceMonitor monitor({});
  for (int i = 0; i < 2000; ++i) monitor.add_scan_likelihood(0.2), monitor.add_scan_fit(0.1);
  EXPECT_EQ(monitor.injection_fraction(), 0.5);
}

TEST(DivergenceMonitor, RangesThatDoNotFitAreEnough) {
  DivergenceMonitor monitor({});
  for (int i = 0; i < 30; ++i) monitor.add_scan_likelihood(0.9), monitor.add_scan_fit(1.0), monitor.add_range(0.02);
  EXPECT_GT(monitor.injection_fraction(), 0.4);
  EXPECT_LT(monitor.range_confidence(), 0.6);
  monitor.reset();
  EXPECT_EQ(monitor.injection_fraction(), 0.0);
}

}  // namespace
}  // namespace patrol::localize::confidence_test
