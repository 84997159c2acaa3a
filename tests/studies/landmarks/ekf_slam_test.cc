#include "studies/landmarks/ekf_slam.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/studies/landmarks/circle_world.h"
#include "tests/support/pose_near.h"

namespace patrol::studies::ekf_slam_test {
namespace {

using test::CircleWorld, test::drive, test::Drive, test::poses_of, test::rmse_m, test::run, test::VectorNear;

constexpr double kExactTol = 1e-12;
const EkfSlamSettings kPlain{.bias = {.std = 0.0}, .is_invariant = false},
    kInvariant{.bias = {.std = 0.0}, .is_invariant = true};

/// The textbook's filter over (x, y, yaw, x of landmark 0, y of landmark 0, ...): dense, slow and obvious.
class TextbookEkf {
 public:
  TextbookEkf(const CircleWorld& world, int num_landmarks)
      : world_(world),
        mean_(Eigen::VectorXd::Zero(3 + 2 * num_landmarks)),
        P_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())),
        is_known_(static_cast<std::size_t>(num_landmarks)) {}

  void step(const Control& control, const std::vector<RangeBearing>& observations) {
    const ControlMotionJacobian jacobian = jacobian_of(world_.motion, pose(), control);
    const Pose2 transformed = world_.motion.move(pose(), control);
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(mean_.size(), mean_.size());
    F.topLeftCorner<3, 3>() = jacobian.pose;
    P_ = F * P_ * F.transpose();
    P_.topLeftCorner<3, 3>() +=
        jacobian.control * world_.motion.std.cwiseAbs2().asDiagonal() * jacobian.control.transpose();
    mean_.head<3>() = transformed.vector();
    std::vector<RangeBearing> firsts;
    for (const RangeBearing& observation : observations) {
      if (is_known_[static_cast<std::size_t>(observation.landmark)]) correct(observation);
      else firsts.push_back(observation);
    }
    for (const RangeBearing& observation : firsts) begin(observation);
  }

  Pose2 pose() const { return {mean_(0), mean_(1), mean_(2)}; }
  Eigen::Matrix3d covariance() const { return P_.topLeftCorner<3, 3>(); }
  Eigen::Vector2d landmark(int i) const { return mean_.segment<2>(3 + 2 * i); }

 private:
  void correct(const RangeBearing& observation) {
    const PredictedObservation predicted = predict_observation(pose(), landmark(observation.landmark));
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, mean_.size());
    H.leftCols<3>() = predicted.H_pose;
    H.middleCols<2>(3 + 2 * observation.landmark) = predicted.H_landmark;
    const Eigen::MatrixXd K = P_ * H.transpose() * (H * P_ * H.transpose() + world_.noise.covariance()).inverse();
    mean_ += K * innovation_of(observation, predicted);
    mean_(2) = wrap_angle(mean_(2));
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(mean_.size(), mean_.size()) - K * H;
    P_ = rest * P_ * rest.transpose() + K * world_.noise.covariance() * K.transpose();  // Joseph's form
  }

  // l = p + r (cos, sin)(yaw + bearing), differentiated by hand.
  void begin(const RangeBearing& observation) {
    is_known_[static_cast<std::size_t>(observation.landmark)] = true;
    const double direction = mean_(2) + observation.bearing_rad, c = std::cos(direction), s = std::sin(direction),
                 r = observation.range_m;
    mean_.segment<2>(3 + 2 * observation.landmark) = mean_.head<2>() + r * Eigen::Vector2d(c, s);
    Eigen::MatrixXd d_by_state = Eigen::MatrixXd::Identity(mean_.size(), mean_.size());
    d_by_state.middleRows<2>(3 + 2 * observation.landmark).setZero();
    d_by_state.block<2, 3>(3 + 2 * observation.landmark, 0) << 1.0, 0.0, -r * s, 0.0, 1.0, r * c;
    const Eigen::Matrix2d d_by_observation = (Eigen::Matrix2d() << c, -r * s, s, r * c).finished();
    P_ = d_by_state * P_ * d_by_state.transpose();
    P_.block<2, 2>(3 + 2 * observation.landmark, 3 + 2 * observation.landmark) +=
        d_by_observation * world_.noise.covariance() * d_by_observation.transpose();
  }

  CircleWorld world_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd P_;
  std::vector<bool> is_known_;
};

// Rounding over 315 steps.
TEST(EkfSlam, PlainIsTheTextbooksFilterToANanometerWithOneLandmarkAndWithEight) {
  for (const int num_landmarks : {1, 8}) {
    CircleWorld world;
    world.num_landmarks = num_landmarks;
    world.range_m = num_landmarks == 1 ? 20.0 : 6.0;
    const Drive measured = drive(world, 1);
    EkfSlam slam(kPlain, world.motion, world.noise);
    TextbookEkf textbook(world, num_landmarks);
    for (std::size_t k = 0; k < measured.controls.size(); ++k) {
      const LandmarkSlamEstimate estimate = slam.step(measured.controls[k], measured.observations[k]);
      textbook.step(measured.controls[k], measured.observations[k]);
      ASSERT_THAT(estimate.T_map_body, test::Pose2Near(textbook.pose(), 1e-9, 1e-9)) << k;
      ASSERT_LT((estimate.covariance - textbook.covariance()).norm(), 1e-9) << k;
    }
    for (int i = 0; i < num_landmarks; ++i)
      EXPECT_THAT(slam.landmarks()[static_cast<std::size_t>(i)].value(), VectorNear(textbook.landmark(i), 1e-9)) << i;
  }
}

// Straight at one landmark, with an error of speed alone: x and the landmark's x are all that is not known. With q =
// (std dt)^2 and R = range_std^2:
//   first step    P_x = q, and the landmark is seen at x + r:     P_l = q + R, P_xl = q
//   second step   P_x = 2 q, z = l - x:                           S = P_x - 2 P_xl + P_l + R = q + 2 R, and x's gain is
//   (P_xl - P_x) / S = -q / S
// so that P_x = 2 q - q^2 / (q + 2 R), and a landmark 0.1 m nearer than expected moves x by 0.1 q / (q + 2 R).
TEST(EkfSlam, StraightAtOneLandmarkIsTheClosedFormPlainAndInvariant) {
  for (const EkfSlamSettings& settings : {kPlain, kInvariant}) {
    const ControlMotion motion{.step_s = 0.1, .std = {2.0, 0.0}};
    const RangeBearingNoise noise{.range_std_m = 0.5, .bearing_std_rad = 0.1};
    const double q = 0.04, R = 0.25;
    EkfSlam slam(settings, motion, noise);
    EXPECT_NEAR(slam.step({1.0, 0.0}, {{.landmark = 0, .range_m = 5.0, .bearing_rad = 0.0}}).covariance(0, 0), q,
                kExactTol);
    const LandmarkSlamEstimate estimate = slam.step({1.0, 0.0}, {{.landmark = 0, .range_m = 4.8, .bearing_rad = 0.0}});
    EXPECT_NEAR(estimate.covariance(0, 0), 2.0 * q - q * q / (q + 2.0 * R), kExactTol);
    EXPECT_NEAR(estimate.T_map_body.x, 0.2 + 0.1 * q / (q + 2.0 * R), kExactTol);
    EXPECT_NEAR(estimate.T_map_body.y, 0.0, kExactTol);
    EXPECT_NEAR(slam.landmarks()[0]->x(), 5.1 - 0.1 * R / (q + 2.0 * R),
                kExactTol);  // its gain is (P_l - P_xl) / S = R / S
  }
}

TEST(EkfSlam, WithoutNoiseIsTheGroundTruth) {
  for (const EkfSlamSettings& settings : {kPlain, kInvariant}) {
    for (const Steering steering : {Steering::kYawRate, Steering::kAckermann}) {
      CircleWorld world;
      world.motion.steering = steering;
      const Drive measured = drive(world, 1, 0.0);
      EkfSlam slam(settings, world.motion, world.noise);
      EXPECT_LT(rmse_m(poses_of(run(slam, measured)), measured.T_map_body), 1e-9);
      for (int i = 0; i < world.num_landmarks; ++i)
        EXPECT_THAT(slam.landmarks()[static_cast<std::size_t>(i)].value(), VectorNear(world.landmark(i), 1e-9)) << i;
    }
  }
}

/// Normalized squared error of the position, mean of 20 seeds, after each step. It is 2 for a filter that knows what it
/// knows.
std::vector<double> position_nees(const EkfSlamSettings& settings, const CircleWorld& world) {
  std::vector<double> nees(static_cast<std::size_t>(world.steps()));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Drive measured = drive(world, seed);
    EkfSlam slam(settings, world.motion, world.noise);
    const std::vector<LandmarkSlamEstimate> estimates = run(slam, measured);
    for (std::size_t k = 0; k < nees.size(); ++k) {
      const Eigen::Vector2d off = estimates[k].T_map_body.position() - measured.T_map_body[k].position();
      nees[k] += off.dot(estimates[k].covariance.topLeftCorner<2, 2>().inverse() * off) / 20.0;
    }
  }
  return nees;
}

// Twenty times it is chi^2 with 40 degrees of freedom: 99.9 % of runs are between 0.8 and 3.9 at a step.
TEST(EkfSlam, InvariantsPositionErrorIsConsistentInTwentySeeds) {
  const std::vector<double> nees = position_nees(kInvariant, {});
  for (const std::size_t k : {99U, 199U, 314U}) {
    EXPECT_GT(nees[k], 0.8) << k;
    EXPECT_LT(nees[k], 3.9) << k;
  }
  double mean = 0.0;
  for (const double value : nees) mean += value / static_cast<double>(nees.size());
  EXPECT_GT(mean, 1.0);
  EXPECT_LT(mean, 4.0);
}

/// After 200 blind steps the heading's variance is 200 q; then landmarks come into sight. The least that the filter
/// believes from there on, over 201 q, the variance at the first sight: the worst of 20 seeds, and the best.
struct LeastVariance {
  double worst = std::numeric_limits<double>::infinity(), best = 0.0;
};

LeastVariance least_heading_variance(const EkfSlamSettings& settings) {
  LeastVariance all;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CircleWorld world;
    world.blind_steps = 200;
    world.range_m = 20.0;
    world.motion.std = {3.0, 0.02};  // positions are so uncertain that each look takes its Jacobians elsewhere
    const Drive measured = drive(world, seed);
    EkfSlam slam(settings, world.motion, world.noise);
    const std::vector<LandmarkSlamEstimate> estimates = run(slam, measured);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 200; k < estimates.size(); ++k)
      least = std::min(least, estimates[k].covariance(2, 2) / (201.0 * 0.002 * 0.002));
    all.worst = std::min(all.worst, least);
    all.best = std::max(all.best, least);
  }
  return all;
}

// Landmarks that were never seen before say nothing of where north is. The invariant filter knows; the plain one learns
// it from its own linearization.
TEST(EkfSlam, InvariantGainsNoInformationOnTheUnobservableHeading) {
  EXPECT_GE(least_heading_variance(kInvariant).worst, 1.0 - 1e-9);
}

TEST(EkfSlam, PlainUnderestimatesTheVarianceOfTheUnobservableHeading) {
  EXPECT_LT(least_heading_variance(kPlain).best, 0.6);
}

CircleWorld biased_world() {
  CircleWorld world;
  world.bias.y() = to_rad(2.0) / world.motion.std.y();  // 2 deg/s: 0.40 standard deviations
  return world;
}

// 29.6: the 99.9 % quantile of chi^2 with ten degrees of freedom, for ten seeds' squared errors in sigmas, once of
// speed and once of turn.
TEST(EkfSlam, FindsAYawBiasOfTwoDegreesPerSecondWithinThreeSigma) {
  for (const bool is_invariant : {false, true}) {
    Eigen::Vector2d chi_squared = Eigen::Vector2d::Zero();
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const CircleWorld world = biased_world();
      EkfSlam slam({.bias = {.std = 1.0}, .is_invariant = is_invariant}, world.motion, world.noise);
      run(slam, drive(world, seed));
      const Eigen::Vector2d sigma = slam.bias().covariance.diagonal().cwiseSqrt(),
                            off = (slam.bias().mean - world.bias).cwiseQuotient(sigma);
      EXPECT_LT(std::abs(off.y()), 3.0) << seed;
      chi_squared += off.cwiseAbs2();
      EXPECT_LT(sigma.y(), 0.06) << seed;  // 1 / sqrt(1 + 315) = 0.0563 is the least, if the path were known
      EXPECT_GE(sigma.y(), 1.0 / std::sqrt(1.0 + 315.0)) << seed;
    }
    EXPECT_LT(chi_squared.x(), 29.6);
    EXPECT_LT(chi_squared.y(), 29.6);
  }
}

TEST(EkfSlam, WithItsBiasEstimatedHalvesTheMeanErrorOfTenSeeds) {
  const CircleWorld world = biased_world();
  double with = 0.0, without = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Drive measured = drive(world, seed);
    EkfSlam one({.bias = {.std = 1.0}, .is_invariant = true}, world.motion, world.noise),
        other(kInvariant, world.motion, world.noise);
    with += rmse_m(poses_of(run(one, measured)), measured.T_map_body) / 10.0;
    without += rmse_m(poses_of(run(other, measured)), measured.T_map_body) / 10.0;
  }
  EXPECT_LT(with, 0.6 * without);
}

// Nothing is seen: the bias and the noise add up, (P_b + 1) for the first step, (4 P_b + 2) for both.
TEST(EkfSlam, WithoutObservationsABiasOfTwoDeviationsMakesTheSecondStepsYawVarianceEighteenNoises) {
  for (const bool is_invariant : {false, true}) {
    const ControlMotion motion{.step_s = 0.1, .std = {0.1, 0.05}};
    EkfSlam slam({.bias = {.std = 2.0}, .is_invariant = is_invariant}, motion, {});
    EXPECT_NEAR(slam.step({1.0, 0.1}, {}).covariance(2, 2), 5.0 * 0.005 * 0.005, kExactTol);
    EXPECT_NEAR(slam.step({1.0, 0.1}, {}).covariance(2, 2), 18.0 * 0.005 * 0.005, kExactTol);
  }
}

TEST(EkfSlam, NoiseScaledByTwoIsFourTimesTheVariance) {
  EkfSlam slam({.noise_scale = 2.0, .bias = {.std = 0.0}, .is_invariant = false}, {.step_s = 0.1, .std = {0.1, 0.05}},
               {});
  EXPECT_NEAR(slam.step({1.0, 0.0}, {}).covariance(2, 2), 4.0 * 0.005 * 0.005, kExactTol);
}

TEST(EkfSlam, AnUnobservedLandmarkHasNoPosition) {
  EkfSlam slam({}, {}, {});
  EXPECT_TRUE(slam.landmarks().empty());
  slam.step({0.0, 0.0}, {{.landmark = 2, .range_m = 3.0, .bearing_rad = 0.5 * std::numbers::pi}});
  ASSERT_EQ(slam.landmarks().size(), 3U);
  EXPECT_FALSE(slam.landmarks()[0].has_value() || slam.landmarks()[1].has_value());
  EXPECT_THAT(slam.landmarks()[2].value(), VectorNear(Eigen::Vector2d(0.0, 3.0), kExactTol));
}

}  // namespace
}  // namespace patrol::studies::ekf_slam_test
