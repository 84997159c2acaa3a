#include "score/localizability.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::score::localizability_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A straight wall: n . p = distance, n towards the room.
struct Wall {
  Eigen::Vector2d normal;
  double offset_m;
};

/// Range and normal along a beam inside a convex room.
std::optional<BeamReturn> look(const std::vector<Wall>& room, const Eigen::Vector2d& p_m, double angle_rad) {
  const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
  std::optional<BeamReturn> nearest;
  for (const Wall& wall : room) {
    const double approach = wall.normal.dot(direction);
    if (approach >= -1e-9) continue;
    const double range_m = (wall.offset_m - wall.normal.dot(p_m)) / approach;
    if (range_m > 0.0 && (!nearest || range_m < nearest->range_m)) {
      nearest = {.direction = direction, .range_m = range_m, .normal = {wall.normal.x(), wall.normal.y(), 0.0}};
    }
  }
  return nearest;
}

std::vector<BeamReturn> scan(const std::vector<Wall>& room, const Eigen::Vector2d& p_m, double yaw_rad = 0.0,
                             int beams = 360) {
  std::vector<BeamReturn> returns;
  for (int beam = 0; beam < beams; ++beam) {
    if (const auto hit = look(room, p_m, yaw_rad + 2.0 * kPi * (beam + 0.5) / beams)) returns.push_back(*hit);
  }
  return returns;
}

const std::vector<Wall> kRoom = {{{1.0, 0.0}, -3.0}, {{-1.0, 0.0}, -5.0}, {{0.0, 1.0}, -2.0}, {{-0.6, -0.8}, -4.0}};
const std::vector<Wall> kCorridor = {{{0.0, 1.0}, -2.0}, {{0.0, -1.0}, -2.0}};

// Each of n beams from the middle of a round room meets its wall head-on, and tells sigma along itself: the sum of
// cos^2 is n / 2.
TEST(Localizability, FromTheMiddleOfARoundRoomTheDeviationIsSigmaTimesTheRootOfTwoOverN) {
  std::vector<BeamReturn> returns;
  for (int i = 0; i < 100; ++i) {
    const double angle = 2.0 * kPi * i / 100;
    returns.push_back({.direction = {std::cos(angle), std::sin(angle)},
                       .range_m = 4.0,
                       .normal = {-std::cos(angle), -std::sin(angle), 0.0}});
  }
  const Localizability result = localizability(returns, {.range_std_m = 0.02});
  EXPECT_NEAR(result.max_std_m, 0.02 * std::sqrt(2.0 / 100.0), 1e-12);
  EXPECT_NEAR(result.min_std_m, result.max_std_m, 1e-12);
  EXPECT_NEAR(result.information(2, 2), 0.0, 1e-9);  // round: it does not tell the heading
}

TEST(Localizability, ACorridorTellsNothingAlongItself) {
  for (const double turn_rad : {0.0, 0.4, -1.2}) {
    std::vector<Wall> turned = kCorridor;
    for (Wall& wall : turned) wall.normal = Eigen::Rotation2Dd(turn_rad) * wall.normal;
    const Localizability result = localizability(scan(turned, {0.0, 0.0}), {.range_std_m = 0.02});
    EXPECT_EQ(result.max_std_m, Localizability::kUnbounded_m);
    EXPECT_TRUE(result.is_degenerate());
    EXPECT_NEAR(std::remainder(result.max_std_direction_rad - turn_rad, kPi), 0.0, 1e-6);
    EXPECT_LT(result.min_std_m, 0.02);
  }
}

TEST(Localizability, AnEmptyScanTellsNothing) {
  const Localizability result = localizability({}, {});
  EXPECT_EQ(result.max_std_m, Localizability::kUnbounded_m);
  EXPECT_EQ(result.min_std_m, Localizability::kUnbounded_m);
}

TEST(Localizability, TwiceTheNoiseIsTwiceTheDeviation) {
  const auto returns = scan(kRoom, {0.5, 0.3});
  EXPECT_NEAR(localizability(returns, {.range_std_m = 0.02}).max_std_m,
              2.0 * localizability(returns, {.range_std_m = 0.01}).max_std_m, 1e-12);
}

TEST(Localizability, ARobotTurnedInThePlaceIsLocalizedAsWell) {
  const Localizability ahead = localizability(scan(kRoom, {0.5, 0.3}), {.range_std_m = 0.02});
  const Localizability turned =
      localizability(scan(kRoom, {0.5, 0.3}, 0.7, 3600), {.range_std_m = 0.02 * std::sqrt(10.0)});
  EXPECT_NEAR(turned.max_std_m / ahead.max_std_m, 1.0, 0.02);
}

// Grazing beams change much with the pose, and as much with their own direction.
TEST(Localizability, AnUncertainDirectionTakesFromGrazingBeamsMost) {
  const std::vector<Wall> wall = {{{0.0, 1.0}, -1.0}};
  const auto head_on = std::vector{*look(wall, {0.0, 0.0}, -kPi / 2.0)},
             grazing = std::vector{*look(wall, {0.0, 0.0}, -0.1)};
  const BeamNoise sure{.range_std_m = 0.01}, unsure{.range_std_m = 0.01, .direction_std_rad = 0.002};
  EXPECT_DOUBLE_EQ(localizability(head_on, sure).information(1, 1), localizability(head_on, unsure).information(1, 1));
  EXPECT_GT(localizability(grazing, sure).information(1, 1), 100.0 * localizability(grazing, unsure).information(1, 1));
}

/// Least squares over x, y, yaw of noisy ranges in a known room: what the bound is of.
Eigen::Vector3d fitted_pose(const std::vector<Wall>& room, const Eigen::Vector3d& truth, double range_std_m,
                            std::uint64_t seed) {
  constexpr int kBeams = 180;
  RandomStream noise(seed, "test/localizability");
  std::array<double, kBeams> ranges_m{};
  const auto angle_of = [](int beam) { return 2.0 * kPi * (beam + 0.5) / kBeams; };
  for (int i = 0; i < kBeams; ++i) {
    ranges_m[static_cast<std::size_t>(i)] = look(room, truth.head<2>(), truth.z() + angle_of(i))->range_m +
                                            range_std_m * noise.normal(static_cast<std::uint64_t>(i));
  }
  Eigen::Vector3d pose = truth;
  for (int iteration = 0; iteration < 4; ++iteration) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (int i = 0; i < kBeams; ++i) {
      const auto range = [&](const Eigen::Vector3d& at) {
        return look(room, at.head<2>(), at.z() + angle_of(i))->range_m;
      };
      Eigen::Vector3d jacobian;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(axis);
        jacobian[axis] = (range(pose + step) - range(pose - step)) / 2e-6;
      }
      A += jacobian * jacobian.transpose();
      b += jacobian * (ranges_m[static_cast<std::size_t>(i)] - range(pose));
    }
    pose += A.ldlt().solve(b);
  }
  return pose;
}

TEST(Localizability, LeastSquaresOverFourHundredNoisyScansSpreadsAsTheBoundSays) {
  constexpr double kRangeStd_m = 0.005;
  const Eigen::Vector3d truth(0.4, 0.2, 0.3);
  const Localizability bound =
      localizability(scan(kRoom, truth.head<2>(), truth.z(), 180), {.range_std_m = kRangeStd_m});
  const Eigen::Vector2d weak(std::cos(bound.max_std_direction_rad), std::sin(bound.max_std_direction_rad));
  const Eigen::Vector2d strong(-weak.y(), weak.x());
  double weak_sum = 0.0, strong_sum = 0.0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector2d error =
        (fitted_pose(kRoom, truth, kRangeStd_m, static_cast<std::uint64_t>(trial + 1)) - truth).head<2>();
    weak_sum += std::pow(error.dot(weak), 2);
    strong_sum += std::pow(error.dot(strong), 2);
  }
  // The deviation of 400 trials is known to 1 / sqrt(800) = 3.5 %.
  EXPECT_NEAR(std::sqrt(weak_sum / kTrials) / bound.max_std_m, 1.0, 0.12);
  EXPECT_NEAR(std::sqrt(strong_sum / kTrials) / bound.min_std_m, 1.0, 0.12);
}

LocalizabilitySample sample(double true_std_m, double reported_std_m, std::optional<double> confidence = {}) {
  LocalizabilitySample sample{
      .truth = {}, .reported_std_m = reported_std_m, .reported_direction_rad = 0.1, .confidence = confidence};
  sample.truth.max_std_m = true_std_m;
  return sample;
}

TEST(LocalizabilityScore, AStackThatKnowsItsWeaknessScoresOneAndOneThatHasItBackwardsNothing) {
  const LocalizabilityScore knows = localizability_score(
      {sample(0.01, 0.02, 0.9), sample(0.05, 0.03, 0.8), sample(0.5, 0.3, 0.3), sample(2.0, 0.9, 0.1)});
  EXPECT_DOUBLE_EQ(*knows.covariance_rank_correlation, 1.0);
  EXPECT_DOUBLE_EQ(*knows.confidence_rank_correlation, -1.0);
  EXPECT_DOUBLE_EQ(*knows.covariance_detection, 1.0);
  EXPECT_DOUBLE_EQ(*knows.confidence_detection, 1.0);
  EXPECT_DOUBLE_EQ(knows.degenerate_fraction, 0.5);
  EXPECT_NEAR(*knows.max_std_direction_error_deg, 0.1 * 180.0 / kPi, 1e-12);

  const LocalizabilityScore backwards = localizability_score({sample(0.01, 0.9), sample(2.0, 0.02)});
  EXPECT_DOUBLE_EQ(*backwards.covariance_rank_correlation, -1.0);
  EXPECT_DOUBLE_EQ(*backwards.covariance_detection, 0.0);
  EXPECT_FALSE(backwards.confidence_detection);
}

TEST(LocalizabilityScore, WithoutDegeneratePosesThereIsNothingToDetect) {
  const LocalizabilityScore score = localizability_score({sample(0.01, 0.02, 1.0), sample(0.02, 0.02, 1.0)});
  EXPECT_FALSE(score.covariance_detection);
  EXPECT_FALSE(score.covariance_rank_correlation);  // what is claimed does not vary
  EXPECT_FALSE(score.max_std_direction_error_deg);
  EXPECT_EQ(localizability_score({}).num_poses, 0u);
}

}  // namespace
}  // namespace patrol::score::localizability_test
