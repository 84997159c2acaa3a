#include "slam/calibration/calibrate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "slam/calibration/motion_residual.h"

namespace patrol::slam {
namespace {

constexpr std::size_t kNumParameters = kCalibrationParameters.size();
using Vector6 = CalibrationVector;
using Matrix6 = Eigen::Matrix<double, kNumParameters, kNumParameters>;

constexpr double kPerMedian = 1.4826;    ///< standard deviation over the median absolute value, of a Gaussian
constexpr double kLeastNoise = 1e-6;     ///< of a log without any
constexpr double kCauchy = 2.5;          ///< standard deviations, while what is right is still looked for
constexpr int kCauchyIterations = 15;
constexpr std::size_t kRuns = 60, kFewestRuns = 20, kStretchesPerRun = 4;
/// Loose enough to weigh nothing, so that also what the log does not tell can be solved for.
const Vector6 kLooseStd{1.0, 1.0, 0.5, 0.5, 0.5, 0.5};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Tukey's biweight, or Cauchy's weight, at a distance of so many standard deviations; and its derivative over the distance.
struct Weight {
  double weight, slope_over_distance;
};
Weight tukey(double distance, double limit) {
  const double inside = std::max(0.0, 1.0 - distance * distance / (limit * limit));
  return {inside * inside, -4.0 * inside / (limit * limit)};
}
Weight cauchy(double distance) { return {1.0 / (1.0 + distance * distance / (kCauchy * kCauchy)), 0.0}; }

/// The estimate, and what it stands on.
class Calibrator {
 public:
  Calibrator(const std::vector<MotionPair>& pairs, const Vector6& before, const CalibratorSettings& settings)
      : pairs_(pairs), before_(before), parameters_(before), settings_(settings) {}

  /// From the values before, with those that are held staying at them.
  void solve(const std::array<bool, kNumParameters>& is_held) {
    parameters_ = before_;
    move_noise_ = turn_noise_ = 1.0;
    converged_ = false;
    for (iterations_ = 0; iterations_ < settings_.max_iterations && !converged_; ++iterations_) {
      const bool is_early = iterations_ < kCauchyIterations;
      evaluate();
      estimate_noise();
      weigh(is_early);
      Matrix6 H = curvature(false);
      Vector6 g = gradient(0, pairs_.size()) + loose_information() * (parameters_ - before_);
      hold(is_held, H, g);
      const Vector6 step = -H.ldlt().solve(g);
      parameters_ += step;
      converged_ = !is_early && step.dot(H * step) < 1e-8;
    }
    evaluate();
    weigh(false);
  }

  /// As the curvature has it, and as the scores of runs of stretches have it.
  Matrix6 curvature_covariance(const std::array<bool, kNumParameters>& is_held) const { return inverse_of(curvature(false), is_held); }
  Matrix6 covariance(const std::array<bool, kNumParameters>& is_held) const {
    const std::size_t runs = std::min(kRuns, pairs_.size() / kStretchesPerRun);
    if (runs < kFewestRuns) return curvature_covariance(is_held);
    Matrix6 scores = Matrix6::Zero();
    for (std::size_t run = 0; run < runs; ++run) {
      const Vector6 score = gradient(run * pairs_.size() / runs, (run + 1) * pairs_.size() / runs);
      scores += score * score.transpose();
    }
    const Matrix6 inverse = inverse_of(curvature(true), is_held);
    return static_cast<double>(runs) / static_cast<double>(runs - 1) * inverse * scores * inverse;
  }

  const Vector6& parameters() const { return parameters_; }
  const std::vector<double>& distances() const { return distances_; }
  double move_noise() const { return move_noise_; }
  double turn_noise() const { return turn_noise_; }
  int iterations() const { return iterations_; }
  bool converged() const { return converged_; }

 private:
  static Matrix6 loose_information() { return kLooseStd.cwiseAbs2().cwiseInverse().asDiagonal(); }

  static void hold(const std::array<bool, kNumParameters>& is_held, Matrix6& H, Vector6& g) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kNumParameters); ++i) {
      if (!is_held[static_cast<std::size_t>(i)]) continue;
      H.row(i).setZero();
      H.col(i).setZero();
      H(i, i) = 1.0;
      g[i] = 0.0;
    }
  }

  static Matrix6 inverse_of(Matrix6 H, const std::array<bool, kNumParameters>& is_held) {
    Vector6 unused = Vector6::Zero();
    hold(is_held, H, unused);
    Matrix6 inverse = H.ldlt().solve(Matrix6::Identity());
    for (std::size_t i = 0; i < kNumParameters; ++i) {
      if (is_held[i]) inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 0.0;
    }
    return inverse;
  }

  void evaluate() {
    residuals_.clear();
    for (const MotionPair& pair : pairs_) residuals_.push_back(motion_residual(pair, parameters_, settings_.odometry));
  }

  /// By what matching knows better than odometry does: elsewhere the residual is small because the tracker believed odometry.
  void estimate_noise() {
    std::vector<double> moves, turns;
    for (const MotionResidual& residual : residuals_) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (residual.lidar_covariance(i, i) > residual.odometry_covariance(i, i)) continue;
        (i < 2 ? moves : turns).push_back(std::abs(residual.error[i]) / std::sqrt(residual.odometry_covariance(i, i)));
      }
    }
    if (!moves.empty()) move_noise_ = std::max(kLeastNoise, kPerMedian * median(std::move(moves)));
    if (!turns.empty()) turn_noise_ = std::max(kLeastNoise, kPerMedian * median(std::move(turns)));
  }

  void weigh(bool is_early) {
    information_.clear();
    distances_.clear();
    weights_.clear();
    for (const MotionResidual& residual : residuals_) {
      information_.push_back(residual.covariance(move_noise_, turn_noise_).inverse());
      distances_.push_back(std::sqrt(residual.error.dot(information_.back() * residual.error)));
      weights_.push_back(is_early ? cauchy(distances_.back()) : tukey(distances_.back(), settings_.outlier_std));
    }
  }

  /// J^T W J; with `is_exact` the derivative of the gradient, in which the weights move too.
  Matrix6 curvature(bool is_exact) const {
    Matrix6 H = loose_information();
    for (std::size_t k = 0; k < residuals_.size(); ++k) {
      const Eigen::Vector3d pull = information_[k] * residuals_[k].error;
      Eigen::Matrix3d W = weights_[k].weight * information_[k];
      if (is_exact) W += weights_[k].slope_over_distance * pull * pull.transpose();
      H += residuals_[k].jacobian.transpose() * W * residuals_[k].jacobian;
    }
    return H;
  }

  Vector6 gradient(std::size_t begin, std::size_t end) const {
    Vector6 g = Vector6::Zero();
    for (std::size_t k = begin; k < end; ++k) g += weights_[k].weight * residuals_[k].jacobian.transpose() * (information_[k] * residuals_[k].error);
    return g;
  }

  const std::vector<MotionPair>& pairs_;
  Vector6 before_, parameters_;
  const CalibratorSettings& settings_;
  double move_noise_ = 1.0, turn_noise_ = 1.0;
  int iterations_ = 0;
  bool converged_ = false;
  std::vector<MotionResidual> residuals_;           ///< [stretch]
  std::vector<Eigen::Matrix3d> information_;  ///< [stretch]
  std::vector<double> distances_;             ///< [stretch], standard deviations
  std::vector<Weight> weights_;               ///< [stretch]
};

/// The one that the log tells worst, of those that it tells worse than it should; none is left to hold.
std::optional<std::size_t> worst_of(const Matrix6& covariance, const Vector6& max_std, const std::array<bool, kNumParameters>& is_held) {
  std::optional<std::size_t> worst;
  double worst_ratio = 1.0;
  for (std::size_t i = 0; i < kNumParameters; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double ratio = std::sqrt(covariance(row, row)) / std::max(1e-12, max_std[row]);
    if (is_held[i] || !(ratio > worst_ratio)) continue;
    worst = i;
    worst_ratio = ratio;
  }
  return worst;
}

}  // namespace

Calibration CalibrationResult::calibration() const {
  const auto& p = parameters;
  return {.places_lidar = p[0].is_observable || p[1].is_observable || p[2].is_observable,
          .lidar_x_m = p[0].value,
          .lidar_y_m = p[1].value,
          .lidar_yaw_rad = wrap_angle(p[2].value),
          .distance_scale = p[3].value,
          .turn_scale = p[4].value,
          .steering_rad_per_m = p[5].value};
}

CalibrationResult calibrate(const std::vector<MotionPair>& pairs, const Pose2& T_body_lidar_before, const CalibratorSettings& settings) {
  if (pairs.size() < static_cast<std::size_t>(settings.min_stretches)) {
    throw InputError(fmt::format("too little to calibrate from: {} stretches of the way, must be at least {}", pairs.size(), settings.min_stretches));
  }
  const Vector6 before{T_body_lidar_before.x, T_body_lidar_before.y, T_body_lidar_before.yaw, 1.0, 1.0, 0.0};
  const Vector6 max_std{settings.max_std_lidar_m,        settings.max_std_lidar_m,    settings.max_std_lidar_rad,
                        settings.max_std_distance_scale, settings.max_std_turn_scale, settings.max_std_steering_rad_per_m};
  Calibrator calibrator(pairs, before, settings);
  CalibrationResult result;
  std::array<bool, kNumParameters> is_held{};
  while (true) {
    calibrator.solve(is_held);
    const std::optional<std::size_t> worst = worst_of(calibrator.curvature_covariance(is_held), max_std, is_held);
    if (!worst) break;
    const auto row = static_cast<Eigen::Index>(*worst);
    result.parameters[*worst].std = std::sqrt(calibrator.curvature_covariance(is_held)(row, row));
    is_held[*worst] = true;
  }
  result.covariance = calibrator.covariance(is_held);
  for (std::size_t i = 0; i < kNumParameters; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    CalibratedParameter& parameter = result.parameters[i];
    parameter.before = before[row];
    parameter.value = calibrator.parameters()[row];
    parameter.is_observable = !is_held[i];
    if (parameter.is_observable) parameter.std = std::sqrt(result.covariance(row, row));
  }
  result.num_stretches = static_cast<int>(pairs.size());
  result.errors = calibrator.distances();
  result.num_rejected = static_cast<int>(std::count_if(result.errors.begin(), result.errors.end(), [&](double error) { return error >= settings.outlier_std; }));
  result.move_noise = calibrator.move_noise();
  result.turn_noise = calibrator.turn_noise();
  result.iterations = calibrator.iterations();
  result.converged = calibrator.converged();
  return result;
}

}  // namespace patrol::slam
