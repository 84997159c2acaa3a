#include "localize/calibration/anchor_delay_estimator.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::localize::anchor_delay_estimator_test {
namespace {

const std::vector<UwbAnchor> kAnchors = {
    {1, {0.0, 2.0, 2.5}}, {2, {20.0, -2.0, 2.5}}, {3, {40.0, 2.0, 2.5}}, {4, {60.0, -2.0, 2.5}}};
const UwbCalibration kNoBias{.distance_m = {}, .bias_m = {}};
const Eigen::Vector3d kAntenna(0.0, 0.0, 0.5);

/// Drives along the anchors and back; every fifth range is too long.
std::vector<CalibrationValue> measure(std::uint64_t seed, const std::vector<double>& delay_m) {
  AnchorDelayEstimator estimator({}, kAnchors, kNoBias);
  const RandomStream random(seed, "ranges");
  for (int k = 0; k < 3000; ++k) {
    const double t = 0.1 * k;
    const Pose2 T_map_body{30.0 - 25.0 * std::cos(0.03 * t), 0.3 * std::sin(0.2 * t), 0.0};
    const std::size_t anchor = static_cast<std::size_t>(k) % kAnchors.size();
    const auto tick = static_cast<std::uint64_t>(k);
    const double nlos_m = random.uniform(tick, 4) < 0.2 ? -0.5 * std::log(random.uniform(tick, 8)) : 0.0;
    const double range_m = predict_uwb_range(kAnchors[anchor], T_map_body, kAntenna, kNoBias).range_m;
    estimator.add({.range = {.stamp = from_seconds(t),
                             .anchor = kAnchors[anchor].number,
                             .range_m = range_m + delay_m[anchor] + nlos_m + 0.07 * random.normal(tick)},
                   .pose = {.stamp = from_seconds(t), .T_map_body = T_map_body},
                   .p_level_antenna = kAntenna});
  }
  return estimator.delays();
}

TEST(AnchorDelayEstimator, RecoversDelaysWithinThreeSigma) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<double> delay_m;
    for (std::uint64_t i = 0; i < kAnchors.size(); ++i) delay_m.push_back(0.1 * RandomStream(seed, "delay").normal(i));
    const std::vector<CalibrationValue> found = measure(seed, delay_m);
    ASSERT_EQ(found.size(), kAnchors.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].name, anchor_delay_name(kAnchors[i].number));
      EXPECT_NEAR(found[i].value, delay_m[i], 3.0 * found[i].std) << found[i].name << ", seed " << seed;
      EXPECT_LT(found[i].std, 0.08) << found[i].name;
    }
  }
}

TEST(AnchorDelayEstimator, IgnoresUnknownAnchors) {
  AnchorDelayEstimator estimator({}, kAnchors, kNoBias);
  estimator.add({.range = {.stamp = {}, .anchor = 99, .range_m = 5.0}, .pose = {}, .p_level_antenna = kAntenna});
  EXPECT_TRUE(estimator.delays().empty());
}

}  // namespace
}  // namespace patrol::localize::anchor_delay_estimator_test
