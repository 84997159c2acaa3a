#include "studies/landmarks/batch_least_squares.h"

#include <gtest/gtest.h>

#include "studies/landmarks/ekf_slam.h"
#include "tests/studies/landmarks/circle_world.h"
#include "tests/support/pose_near.h"

namespace patrol::studies::batch_least_squares_test {
namespace {

using test::CircleWorld, test::dead_reckoning, test::drive, test::Drive, test::poses_of, test::rmse_m, test::run,
    test::VectorNear;

constexpr double kSolverTol = 1e-4;  // m

CircleWorld world_of(Steering steering) {
  CircleWorld world;
  world.motion.steering = steering;
  return world;
}

/// Poses as they are, and each landmark where its first sight says.
BatchSolution guess_of(const std::vector<Pose2>& poses, const std::vector<std::vector<RangeBearing>>& observations,
                       int num_landmarks) {
  BatchSolution guess{.T_map_body = poses, .landmarks = {}};
  guess.landmarks.resize(static_cast<std::size_t>(num_landmarks));
  for (std::size_t k = 0; k < observations.size(); ++k) {
    for (const RangeBearing& observation : observations[k]) {
      std::optional<Eigen::Vector2d>& landmark = guess.landmarks[static_cast<std::size_t>(observation.landmark)];
      if (!landmark) landmark = invert_observation(poses[k], observation);
    }
  }
  return guess;
}

void expect_truth(const CircleWorld& world, const Drive& measured, const BatchSolution& solution) {
  EXPECT_TRUE(solution.has_converged);
  EXPECT_LT(rmse_m(solution.T_map_body, measured.T_map_body), kSolverTol);
  for (int i = 0; i < world.num_landmarks; ++i)
    EXPECT_THAT(solution.landmarks[static_cast<std::size_t>(i)].value(), VectorNear(world.landmark(i), kSolverTol))
        << i;
}

// The guess is what odometry would tell that is 2 degrees per second, or 2 degrees of steering, off all the way.
TEST(SolveBatch, RecoversTheGroundTruthFromNoiselessDataAndAGuessMetersOff) {
  for (const Steering steering : {Steering::kYawRate, Steering::kAckermann}) {
    const CircleWorld world = world_of(steering);
    const Drive measured = drive(world, 1, 0.0);
    std::vector<Control> off = measured.controls;
    for (Control& control : off) control.y() += 0.035;
    const BatchSolution guess = guess_of(dead_reckoning(world.motion, off), measured.observations, world.num_landmarks);
    EXPECT_GT(rmse_m(guess.T_map_body, measured.T_map_body), 1.0);
    expect_truth(world, measured,
                 solve_batch(world.motion, world.noise, measured.controls, measured.observations, guess));
  }
}

/// Drive of 20 steps without noise.
Drive noiseless(const CircleWorld& world, const Control& control) {
  Drive drive;
  Pose2 pose;
  for (int k = 0; k < 20; ++k) {
    drive.T_map_body.push_back(pose = world.motion.move(pose, control));
    drive.controls.push_back(control);
    drive.observations.emplace_back();
    for (int i = 0; i < world.num_landmarks; ++i) {
      const Eigen::Vector2d observation = predict_observation(pose, world.landmark(i)).observation;
      drive.observations.back().push_back({.landmark = i, .range_m = observation.x(), .bearing_rad = observation.y()});
    }
  }
  return drive;
}

TEST(SolveBatch, RestAndBackwardMotionAreRecoveredToo) {
  for (const Steering steering : {Steering::kYawRate, Steering::kAckermann}) {
    for (const double speed_mps : {0.0, -1.0}) {
      const CircleWorld world = world_of(steering);
      const Drive measured = noiseless(world, {speed_mps, world.control().y()});
      BatchSolution guess = guess_of(measured.T_map_body, measured.observations, world.num_landmarks);
      for (auto& landmark : guess.landmarks) *landmark += Eigen::Vector2d(0.1, -0.2);
      expect_truth(world, measured,
                   solve_batch(world.motion, world.noise, measured.controls, measured.observations, guess));
    }
  }
}

TEST(SolveBatch, WithNoiseBeatsBothEkfsOnTheMeanOfTenSeeds) {
  for (const Steering steering : {Steering::kYawRate, Steering::kAckermann}) {
    const CircleWorld world = world_of(steering);
    double batch = 0.0, plain = 0.0, invariant = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Drive measured = drive(world, seed);
      EkfSlam plain_slam({.bias = {.std = 0.0}, .is_invariant = false}, world.motion, world.noise),
          invariant_slam({.bias = {.std = 0.0}}, world.motion, world.noise);
      const std::vector<Pose2> guess = poses_of(run(plain_slam, measured));
      const BatchSolution solution = solve_batch(world.motion, world.noise, measured.controls, measured.observations,
                                                 {.T_map_body = guess, .landmarks = plain_slam.landmarks()});
      EXPECT_TRUE(solution.has_converged) << seed;
      batch += rmse_m(solution.T_map_body, measured.T_map_body) / 10.0;
      plain += rmse_m(guess, measured.T_map_body) / 10.0;
      invariant += rmse_m(poses_of(run(invariant_slam, measured)), measured.T_map_body) / 10.0;
    }
    EXPECT_LT(batch, plain);
    EXPECT_LT(batch, invariant);
  }
}

// One step and one landmark, both straight ahead: odometry says 0.2 m to 0.2 m (variance q = 0.2^2, sd 2 m/s for 0.1
// s), then 5.0 m of range before and 4.7 after the second. The ranges say that it came 0.3 m, with variance 2 R = 0.5:
// it came 0.2 + 0.1 q / (q + 2 R).
TEST(SolveBatch, OfTwoRangesAndOneStepIsTheWeightedMean) {
  const ControlMotion motion{.step_s = 0.1, .std = {2.0, 1e-3}};
  const RangeBearingNoise noise{.range_std_m = 0.5, .bearing_std_rad = 0.1};
  const std::vector<std::vector<RangeBearing>> observations = {{{.landmark = 0, .range_m = 5.0, .bearing_rad = 0.0}},
                                                               {{.landmark = 0, .range_m = 4.7, .bearing_rad = 0.0}}};
  const std::vector<Control> controls = {{2.0, 0.0}, {2.0, 0.0}};
  const BatchSolution solution =
      solve_batch(motion, noise, controls, observations, guess_of(dead_reckoning(motion, controls), observations, 1));
  EXPECT_NEAR(solution.T_map_body[0].x, 0.2, kSolverTol);  // where it first looked from is odometry's alone
  EXPECT_NEAR(solution.T_map_body[1].x, 0.4 + 0.1 * 0.04 / (0.04 + 0.5), kSolverTol);
}

TEST(SolveBatch, ALandmarkThatIsNotInTheGuessHasNoPosition) {
  const ControlMotion motion;
  const BatchSolution solution =
      solve_batch(motion, {}, {{1.0, 0.0}}, {{}}, {.T_map_body = {{0.1, 0.0, 0.0}}, .landmarks = {std::nullopt}});
  EXPECT_TRUE(solution.has_converged);
  EXPECT_FALSE(solution.landmarks[0].has_value());
}

}  // namespace
}  // namespace patrol::studies::batch_least_squares_test
