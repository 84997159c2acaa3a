#include "slam/motion_model.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "slam/rbpf/proposal.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::motion_model_test {
namespace {

using test::Pose2Near, test::VectorNear;

constexpr double kExactTol = 1e-12;
constexpr double kPi = std::numbers::pi;

// Whole numbers: 0.3 along and 0.1 across per meter, 0.2 per rad, 0.4 per meter and 0.5 per second of turn.
const MotionModelSettings kSettings{.longitudinal_std_m_per_m = 0.3,
                                    .lateral_std_m_per_m = 0.1,
                                    .yaw_std_rad_per_rad = 0.2,
                                    .yaw_std_rad_per_m = 0.4,
                                    .yaw_std_rad_per_s = 0.5,
                                    .min_std_m = 0.01,
                                    .min_std_rad = 0.02};

TEST(PredictMotion, MeanIsTheOdometrysMoveFromWhereTheBodyWas) {
  const Pose2 before{1.0, 2.0, kPi / 2.0};
  EXPECT_THAT(predict_motion(before, {3.0, 1.0, 0.5}, 0.1, kSettings).mean,
              Pose2Near((Pose2{0.0, 5.0, kPi / 2.0 + 0.5}), kExactTol, kExactTol));
}

TEST(PredictMotion, TwoMetersNorthSpreadSixtyCentimetersNorthAndTwentyEast) {
  const Eigen::Matrix3d P = predict_motion({0.0, 0.0, kPi / 2.0}, {2.0, 0.0, 0.0}, 0.0, kSettings).covariance;
  EXPECT_NEAR(P(0, 0), 0.2 * 0.2 + 1e-4, kExactTol);
  EXPECT_NEAR(P(1, 1), 0.6 * 0.6 + 1e-4, kExactTol);
  EXPECT_NEAR(P(0, 1), 0.0, kExactTol);
  EXPECT_NEAR(P(2, 2), 0.8 * 0.8 + 4e-4, kExactTol);
}

TEST(PredictMotion, SidewaysStepsSpreadAlongTheStep) {
  const Eigen::Matrix3d P = predict_motion({}, {0.0, 1.0, 0.0}, 0.0, kSettings).covariance;
  EXPECT_NEAR(P(1, 1), 0.3 * 0.3 + 1e-4, kExactTol);
  EXPECT_NEAR(P(0, 0), 0.1 * 0.1 + 1e-4, kExactTol);
}

TEST(PredictMotion, HeadingSpreadsByRotationDistanceAndTimeAsASumOfSquares) {
  const double var = predict_motion({}, {0.3, 0.4, -1.5}, 2.0, kSettings).covariance(2, 2);
  EXPECT_NEAR(var, 0.3 * 0.3 + 0.2 * 0.2 + 1.0 * 1.0 + 4e-4, kExactTol);  // 0.2 x 1.5; 0.4 x 0.5 m; 0.5 x 2 s
}

TEST(PredictMotion, AtRestTheSpreadIsTheMinimum) {
  const Eigen::Matrix3d P = predict_motion({5.0, 6.0, 1.0}, {}, 0.0, kSettings).covariance;
  EXPECT_TRUE(P.isApprox(Eigen::Vector3d(1e-4, 1e-4, 4e-4).asDiagonal().toDenseMatrix(), kExactTol)) << P;
}

// Draws have the mean and covariance that they are said to have: bounds of four standard errors,
// var(sample covariance ij) = (P_ii P_jj + P_ij^2) / n.
TEST(ProposalSample, HasTheMomentsOfItsPosterior) {
  const Proposal proposal{.posterior = predict_motion({1.0, 2.0, 0.7}, {0.8, 0.3, 0.4}, 1.0, kSettings)};
  const Eigen::Matrix3d P = proposal.posterior.covariance;
  const RandomStream stream(1, "test/draws");
  constexpr int kDraws = 50'000;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const Pose2 drawn = proposal.sample({stream.normal(i, 0), stream.normal(i, 1), stream.normal(i, 2)});
    const Eigen::Vector3d offset = proposal.posterior.residual_to_mean(drawn);
    mean += offset / kDraws;
    covariance += offset * offset.transpose() / kDraws;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean[i], 0.0, 4.0 * std::sqrt(P(i, i) / kDraws)) << i;
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(covariance(i, j), P(i, j), 4.0 * std::sqrt((P(i, i) * P(j, j) + P(i, j) * P(i, j)) / kDraws))
          << i << j;
    }
  }
}

TEST(MotionModelSettings, RefuseANegativeSpreadByName) {
  MotionModelSettings settings;
  settings.lateral_std_m_per_m = -0.1;
  try {
    validate(settings, "slam.motion");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "slam.motion.lateral_std_m_per_m = -0.1: must be at least 0");
  }
}

}  // namespace
}  // namespace patrol::slam::motion_model_test
