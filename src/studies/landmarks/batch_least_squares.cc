#include "studies/landmarks/batch_least_squares.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include <ceres/ceres.h>

namespace patrol::studies {
namespace {

/// Standard deviation of a pose relative to the prediction of the corrected control. The constraint is exact in theory;
/// a small value keeps it differentiable.
constexpr double kTight = 1e-4;  // m, rad

template <typename Scalar>
Scalar wrapped(const Scalar& angle) {
  return atan2(sin(angle), cos(angle));
}

/// Motion residual; `error` is the control error in standard deviations.
struct MotionCost {
  ControlMotion motion;
  Control control;

  template <typename Scalar>
  bool operator()(const Scalar* before, const Scalar* error, const Scalar* after, Scalar* residual) const {
    const Scalar corrected[2] = {control.x() + motion.std.x() * error[0], control.y() + motion.std.y() * error[1]};
    Scalar pose[3] = {before[0], before[1], before[2]};
    move_in_place(motion, corrected, pose);
    residual[0] = (after[0] - pose[0]) / kTight;
    residual[1] = (after[1] - pose[1]) / kTight;
    residual[2] = wrapped(Scalar(after[2] - pose[2])) / kTight;
    residual[3] = error[0];
    residual[4] = error[1];
    return true;
  }
};

struct ObservationCost {
  RangeBearing observations;
  RangeBearingNoise noise;

  template <typename Scalar>
  bool operator()(const Scalar* pose, const Scalar* landmark, Scalar* residual) const {
    const Scalar dx = landmark[0] - pose[0], dy = landmark[1] - pose[1];
    residual[0] = (sqrt(dx * dx + dy * dy) - observations.range_m) / noise.range_std_m;
    residual[1] = wrapped(Scalar(atan2(dy, dx) - pose[2] - observations.bearing_rad)) / noise.bearing_std_rad;
    return true;
  }
};

}  // namespace

BatchSolution solve_batch(const ControlMotion& motion, const RangeBearingNoise& noise,
                          const std::vector<Control>& controls,
                          const std::vector<std::vector<RangeBearing>>& observations, const BatchSolution& guess) {
  std::vector<std::array<double, 3>> poses = {{0.0, 0.0, 0.0}};
  for (const Pose2& pose : guess.T_map_body) poses.push_back({pose.x, pose.y, pose.yaw});
  std::vector<std::array<double, 2>> landmarks;
  for (const auto& landmark : guess.landmarks)
    landmarks.push_back(landmark ? std::array{landmark->x(), landmark->y()} : std::array{0.0, 0.0});

  std::vector<std::array<double, 2>> errors(controls.size(), {0.0, 0.0});

  ceres::Problem problem;
  problem.AddParameterBlock(poses[0].data(), 3);
  problem.SetParameterBlockConstant(poses[0].data());
  for (std::size_t k = 0; k < controls.size(); ++k) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<MotionCost, 5, 3, 2, 3>(new MotionCost{motion, controls[k]}), nullptr,
        poses[k].data(), errors[k].data(), poses[k + 1].data());
    for (const RangeBearing& observation : observations[k]) {
      if (static_cast<std::size_t>(observation.landmark) >= landmarks.size())
        throw std::invalid_argument("batch: guess must contain every observed landmark");
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ObservationCost, 2, 3, 2>(new ObservationCost{observation, noise}), nullptr,
          poses[k + 1].data(), landmarks[static_cast<std::size_t>(observation.landmark)].data());
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;  // a guess with an error of meters needs 55 iterations
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  BatchSolution solution{
      .T_map_body = {}, .landmarks = guess.landmarks, .has_converged = summary.termination_type == ceres::CONVERGENCE};
  for (std::size_t k = 1; k < poses.size(); ++k)
    solution.T_map_body.push_back({poses[k][0], poses[k][1], wrap_angle(poses[k][2])});
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (solution.landmarks[i]) solution.landmarks[i] = Eigen::Vector2d(landmarks[i][0], landmarks[i][1]);
  }
  return solution;
}

}  // namespace patrol::studies
