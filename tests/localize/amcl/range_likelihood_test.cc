#include "localize/amcl/range_likelihood.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "localize/amcl/range_buffer.h"

namespace patrol::localize::amcl_range_likelihood_test {
namespace {

constexpr RangeLikelihoodSettings kSettings{};

TEST(RangeLikelihood, FallsAsAGaussianNearTheExpectedRange) {
  const double at_0 = std::exp(range_log_likelihood(-1e-12, kSettings)),
               at_1 = std::exp(range_log_likelihood(-0.15, kSettings));
  EXPECT_NEAR(at_0, 0.88 + 0.02, 1e-9);
  EXPECT_NEAR(at_1, 0.88 * std::exp(-0.5) + 0.02, 1e-9);
}

TEST(RangeLikelihood, ARangeTooLongIsLikelierThanOneTooShort) {
  EXPECT_GT(range_log_likelihood(0.6, kSettings), range_log_likelihood(-0.6, kSettings) + 0.8);
}

TEST(RangeLikelihood, NoOutlierCostsMoreThanItsFloor) {
  for (const double innovation_m : {-100.0, 30.0})
    EXPECT_NEAR(range_log_likelihood(innovation_m, kSettings), std::log(0.02), 1e-6);
}

// Anchor 4 m aside and 3 m up: 5 m to an antenna at the origin; the antenna is 1 m ahead of a body that looks along y.
TEST(NlosBias, CountsHeightAndLever) {
  const AnchoredRange range{.p_map_anchor = {4.0, 1.0, 3.5}, .p_body_antenna = {1.0, 0.0, 0.5}, .range_m = 5.2};
  EXPECT_NEAR(range_innovation_m(range, {0.0, 0.0, std::numbers::pi / 2.0}), 0.2, 1e-12);
}

const std::vector<UwbAnchor> kAnchors = {{7, {10.0, 0.0, 2.0}}};

// An exact range and one that is 8 m too short, whose likelihood is the floor of the mixture.
TEST(MeanRangeLikelihood, OfAnExactRangeAndAnOutlierIsHalfOfTheirSum) {
  const std::vector<AnchoredRange> ranges = {{{3.0, 4.0, 0.0}, Eigen::Vector3d::Zero(), 5.0},
                                             {{10.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 2.0}};
  EXPECT_NEAR(mean_range_likelihood(ranges, {}, {}), 0.5 * (0.9 + 0.02), 1e-9);
  EXPECT_EQ(mean_range_likelihood({}, {}, {}), 1.0);
}

TEST(RangeBuffer, KeepsTheNewestRangeOfEachKnownAnchorAndNothingElse) {
  RangeBuffer memory(kAnchors, {});
  memory.add({Time{1}, 7, 9.0}, {});
  memory.add({Time{2}, 7, 9.5}, {});
  memory.add({Time{3}, 8, 9.5}, {});
  memory.add({Time{3}, 7, std::numeric_limits<double>::quiet_NaN()}, {});
  memory.add({Time{3}, 7, -1.0}, {});
  ASSERT_EQ(memory.ranges_since(Time{0}, {}).size(), 1U);
  EXPECT_GT(memory.ranges_since(Time{0}, {}).front().range_m, 9.4);
  EXPECT_TRUE(memory.ranges_since(Time{2}, {}).empty());
}

// A range read at 10.2 m is 21 mm too long (the calibration's table); what is left must be the distance.
TEST(RangeBuffer, TakesOffTheBiasOfAClearRange) {
  RangeBuffer memory(kAnchors, {});
  const double true_m = std::hypot(10.0, 2.0);
  memory.add({Time{1}, 7, true_m + uwb_bias_at({}, true_m).bias_m}, {});
  EXPECT_NEAR(range_innovation_m(memory.ranges_since(Time{0}, {}).front(), {}), 0.0, 1e-3);
}

// The range is 2 m and a quarter turn old: its antenna, 0.5 m ahead then, is 2 m behind and 0.5 m to the right now.
TEST(RangeBuffer, SeesAnOldRangeFromWhereTheBodyIsNow) {
  RangeBuffer memory(kAnchors, {{0.5, 0.0, 0.3}, Eigen::Quaterniond::Identity()});
  memory.add({Time{1}, 7, 9.0}, to_pose3({0.0, 0.0, 0.0}));
  const AnchoredRange range = memory.ranges_since(Time{0}, {0.0, -2.0, std::numbers::pi / 2.0}).front();
  EXPECT_NEAR((range.p_body_antenna - Eigen::Vector3d(2.0, -0.5, 0.3)).norm(), 0.0, 1e-12);
}

TEST(RangeBuffer, ATiltedBodyCarriesItsAntennaAlong) {
  RangeBuffer memory(kAnchors, {{0.0, 0.0, 1.0}, Eigen::Quaterniond::Identity()});
  memory.add({Time{1}, 7, 9.0}, {Eigen::Vector3d::Zero(), quaternion_from_rpy(0.0, 0.25, 0.0)});
  const Eigen::Vector3d expected(std::sin(0.25), 0.0, std::cos(0.25));
  EXPECT_NEAR((memory.ranges_since(Time{0}, {}).front().p_body_antenna - expected).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace patrol::localize::amcl_range_likelihood_test
