#include "slam/landmarks/batch_least_squares.h"

#include <ceres/ceres.h>

#include <array>
#include <cmath>

namespace patrol::slam {
namespace {

/// Three residuals for two errors: sideways slip, which these vehicles do not have, is held to a tenth of a millimetre.
constexpr double kSlipStd_m = 1e-4;

template <typename Scalar>
Scalar wrapped(const Scalar& angle) {
  return atan2(sin(angle), cos(angle));
}

/// Errors of a control that would take one pose to the next.
struct ControlCost {
  ControlMotion motion;
  Control control;

  template <typename Scalar>
  bool operator()(const Scalar* before, const Scalar* after, Scalar* residual) const {
    const Scalar dx = after[0] - before[0], dy = after[1] - before[1], turn = wrapped(Scalar(after[2] - before[2]));
    if (motion.steering == Steering::kAckermann) {  // the step goes where the wheel points, and turns the car by its sideways part
      const Scalar c = cos(before[2]), s = sin(before[2]);
      const Scalar along = c * dx + s * dy, across = -s * dx + c * dy;
      residual[0] = (sqrt(along * along + across * across + 1e-12) / motion.step_s - control.x()) / motion.std.x();
      residual[1] = (atan2(across, along) - control.y()) / motion.std.y();
      residual[2] = (turn * motion.wheelbase_m - across) / kSlipStd_m;
      return true;
    }
    const Scalar c = cos(before[2] + 0.5 * turn), s = sin(before[2] + 0.5 * turn);
    residual[0] = ((c * dx + s * dy) / motion.step_s - control.x()) / motion.std.x();
    residual[1] = (turn / motion.step_s - control.y()) / motion.std.y();
    residual[2] = (-s * dx + c * dy) / kSlipStd_m;
    return true;
  }
};

struct SightCost {
  RangeBearing seen;
  RangeBearingNoise noise;

  template <typename Scalar>
  bool operator()(const Scalar* pose, const Scalar* landmark, Scalar* residual) const {
    const Scalar dx = landmark[0] - pose[0], dy = landmark[1] - pose[1];
    residual[0] = (sqrt(dx * dx + dy * dy) - seen.range_m) / noise.range_std_m;
    residual[1] = wrapped(Scalar(atan2(dy, dx) - pose[2] - seen.bearing_rad)) / noise.bearing_std_rad;
    return true;
  }
};

}  // namespace

BatchSolution solve_batch(const ControlMotion& motion, const RangeBearingNoise& noise, const std::vector<Control>& controls,
                          const std::vector<std::vector<RangeBearing>>& seen, const BatchSolution& guess) {
  std::vector<std::array<double, 3>> poses = {{0.0, 0.0, 0.0}};
  for (const Pose2& pose : guess.T_map_body) poses.push_back({pose.x, pose.y, pose.yaw});
  std::vector<std::array<double, 2>> landmarks;
  for (const auto& landmark : guess.landmarks) landmarks.push_back(landmark ? std::array{landmark->x(), landmark->y()} : std::array{0.0, 0.0});

  ceres::Problem problem;
  problem.AddParameterBlock(poses[0].data(), 3);
  problem.SetParameterBlockConstant(poses[0].data());
  for (std::size_t k = 0; k < controls.size(); ++k) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ControlCost, 3, 3, 3>(new ControlCost{motion, controls[k]}), nullptr, poses[k].data(),
                             poses[k + 1].data());
    for (const RangeBearing& sight : seen[k]) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SightCost, 2, 3, 2>(new SightCost{sight, noise}), nullptr, poses[k + 1].data(),
                               landmarks[static_cast<std::size_t>(sight.landmark)].data());
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  BatchSolution solution{.T_map_body = {}, .landmarks = guess.landmarks, .has_converged = summary.termination_type == ceres::CONVERGENCE};
  for (std::size_t k = 1; k < poses.size(); ++k) solution.T_map_body.push_back({poses[k][0], poses[k][1], wrap_angle(poses[k][2])});
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (solution.landmarks[i]) solution.landmarks[i] = Eigen::Vector2d(landmarks[i][0], landmarks[i][1]);
  }
  return solution;
}

}  // namespace patrol::slam
