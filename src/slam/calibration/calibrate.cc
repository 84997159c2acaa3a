#include "slam/calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "core/upper_median.h"
#include "slam/calibration/motion_residual.h"

namespace patrol::slam {
namespace {

constexpr std::size_t kNumParameters = kCalibrationParameters.size();
using Vector6 = CalibrationVector;
using Matrix6 = Eigen::Matrix<double, kNumParameters, kNumParameters>;

constexpr double kStdPerMedian = 1.4826;  ///< ratio of standard deviation to median absolute value of a Gaussian
constexpr double kMinNoiseScale = 1e-6;   ///< lower bound of the noise scales, for logs without noise
constexpr double kCauchy = 2.5;  ///< scale of the Cauchy weights in standard deviations, for the first iterations
constexpr int kCauchyIterations = 15;
constexpr std::size_t kGroups = 60, kMinGroups = 20, kSegmentsPerGroup = 4;
/// Prior standard deviations, wide enough to have no influence, that keep unobservable parameters solvable.
const Vector6 kLooseStd{1.0, 1.0, 0.5, 0.5, 0.5, 0.5};

/// Weight of Tukey's biweight or Cauchy's kernel at a distance in standard deviations, and its derivative divided by
/// the distance.
struct Weight {
  double weight, slope_over_distance;
};
Weight tukey(double distance, double limit) {
  const double inside = std::max(0.0, 1.0 - distance * distance / (limit * limit));
  return {inside * inside, -4.0 * inside / (limit * limit)};
}
Weight cauchy(double distance) { return {1.0 / (1.0 + distance * distance / (kCauchy * kCauchy)), 0.0}; }

/// State of the estimation.
class Calibrator {
 public:
  Calibrator(const std::vector<MotionSegment>& pairs, const Vector6& before, const CalibratorSettings& settings)
      : pairs_(pairs), before_(before), parameters_(before), settings_(settings) {}

  /// Estimates the parameters from the initial values; held parameters keep them.
  void solve(const std::array<bool, kNumParameters>& is_fixed) {
    parameters_ = before_;
    translation_noise_scale_ = rotation_noise_scale_ = 1.0;
    converged_ = false;
    for (iterations_ = 0; iterations_ < settings_.max_iterations && !converged_; ++iterations_) {
      const bool is_early = iterations_ < kCauchyIterations;
      evaluate();
      estimate_noise();
      update_weights(is_early);
      Matrix6 H = curvature(false);
      Vector6 g = gradient(0, pairs_.size()) + loose_information() * (parameters_ - before_);
      fix_parameters(is_fixed, H, g);
      const Vector6 step = -solve_symmetric(H, g);
      parameters_ += step;
      converged_ = !is_early && step.dot(H * step) < 1e-8;
    }
    evaluate();
    update_weights(false);
  }

  /// Covariance from the curvature, and from the scores of groups of segments (sandwich estimator).
  Matrix6 curvature_covariance(const std::array<bool, kNumParameters>& is_fixed) const {
    return inverse_without_fixed(curvature(false), is_fixed);
  }
  Matrix6 covariance(const std::array<bool, kNumParameters>& is_fixed) const {
    const std::size_t runs = std::min(kGroups, pairs_.size() / kSegmentsPerGroup);
    if (runs < kMinGroups) return curvature_covariance(is_fixed);
    Matrix6 scores = Matrix6::Zero();
    for (std::size_t run = 0; run < runs; ++run) {
      const Vector6 score = gradient(run * pairs_.size() / runs, (run + 1) * pairs_.size() / runs);
      scores += score * score.transpose();
    }
    const Matrix6 inverse = inverse_without_fixed(curvature(true), is_fixed);
    return static_cast<double>(runs) / static_cast<double>(runs - 1) * inverse * scores * inverse;
  }

  const Vector6& parameters() const { return parameters_; }
  const std::vector<double>& distances() const { return distances_; }
  double translation_noise_scale() const { return translation_noise_scale_; }
  double rotation_noise_scale() const { return rotation_noise_scale_; }
  int iterations() const { return iterations_; }
  bool converged() const { return converged_; }

 private:
  static Matrix6 loose_information() { return kLooseStd.cwiseAbs2().cwiseInverse().asDiagonal(); }

  static void fix_parameters(const std::array<bool, kNumParameters>& is_fixed, Matrix6& H, Vector6& g) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kNumParameters); ++i) {
      if (!is_fixed[static_cast<std::size_t>(i)]) continue;
      H.row(i).setZero();
      H.col(i).setZero();
      H(i, i) = 1.0;
      g[i] = 0.0;
    }
  }

  static Matrix6 inverse_without_fixed(Matrix6 H, const std::array<bool, kNumParameters>& is_fixed) {
    Vector6 unused = Vector6::Zero();
    fix_parameters(is_fixed, H, unused);
    Matrix6 inverse = H.ldlt().solve(Matrix6::Identity());
    for (std::size_t i = 0; i < kNumParameters; ++i) {
      if (is_fixed[i]) inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 0.0;
    }
    return inverse;
  }

  void evaluate() {
    residuals_.clear();
    for (const MotionSegment& pair : pairs_)
      residuals_.push_back(motion_residual(pair, parameters_, settings_.odometry));
  }

  /// Uses only components that matching constrains better than odometry; elsewhere the tracker followed odometry, so
  /// the residual is too small. Without such components the noise is that of the settings.
  void estimate_noise() {
    translation_noise_scale_ = rotation_noise_scale_ = 1.0;
    std::vector<double> translation_errors, rotation_errors;
    for (const MotionResidual& residual : residuals_) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (residual.lidar_covariance(i, i) > residual.odometry_covariance(i, i)) continue;
        (i < 2 ? translation_errors : rotation_errors)
            .push_back(std::abs(residual.error[i]) / std::sqrt(residual.odometry_covariance(i, i)));
      }
    }
    if (!translation_errors.empty())
      translation_noise_scale_ = std::max(kMinNoiseScale, kStdPerMedian * upper_median(std::move(translation_errors)));
    if (!rotation_errors.empty())
      rotation_noise_scale_ = std::max(kMinNoiseScale, kStdPerMedian * upper_median(std::move(rotation_errors)));
  }

  void update_weights(bool is_early) {
    information_.clear();
    distances_.clear();
    weights_.clear();
    for (const MotionResidual& residual : residuals_) {
      information_.emplace_back(residual.covariance(translation_noise_scale_, rotation_noise_scale_).inverse());
      distances_.push_back(std::sqrt(residual.error.dot(information_.back() * residual.error)));
      weights_.push_back(is_early ? cauchy(distances_.back()) : tukey(distances_.back(), settings_.outlier_sigma));
    }
  }

  /// Curvature J^T W J; with `is_exact` the derivative of the gradient including that of the weights.
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
    for (std::size_t k = begin; k < end; ++k)
      g += weights_[k].weight * residuals_[k].jacobian.transpose() * (information_[k] * residuals_[k].error);
    return g;
  }

  const std::vector<MotionSegment>& pairs_;
  Vector6 before_, parameters_;
  const CalibratorSettings& settings_;
  double translation_noise_scale_ = 1.0, rotation_noise_scale_ = 1.0;
  int iterations_ = 0;
  bool converged_ = false;
  std::vector<MotionResidual> residuals_;     ///< [segment]
  std::vector<Eigen::Matrix3d> information_;  ///< [segment]
  std::vector<double> distances_;             ///< [segment], standard deviations
  std::vector<Weight> weights_;               ///< [segment]
};

/// Returns the free parameter with the largest ratio of standard deviation to limit, if the ratio exceeds 1; otherwise
/// none.
std::optional<std::size_t> find_worst(const Matrix6& covariance, const Vector6& max_std,
                                      const std::array<bool, kNumParameters>& is_fixed) {
  std::optional<std::size_t> worst;
  double worst_ratio = 1.0;
  for (std::size_t i = 0; i < kNumParameters; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double ratio = std::sqrt(covariance(row, row)) / std::max(1e-12, max_std[row]);
    if (is_fixed[i] || !(ratio > worst_ratio)) continue;
    worst = i;
    worst_ratio = ratio;
  }
  return worst;
}

}  // namespace

Calibration CalibrationResult::calibration() const {
  const auto& p = parameters;
  return {.override_lidar_pose = p[0].is_observable || p[1].is_observable || p[2].is_observable,
          .lidar_x_m = p[0].value,
          .lidar_y_m = p[1].value,
          .lidar_yaw_rad = wrap_angle(p[2].value),
          .distance_scale = p[3].value,
          .rotation_scale = p[4].value,
          .steering_bias_rad_per_m = p[5].value};
}

CalibrationResult calibrate(const std::vector<MotionSegment>& pairs, const Pose2& T_body_lidar_before,
                            const CalibratorSettings& settings) {
  if (pairs.size() < static_cast<std::size_t>(settings.min_segments)) {
    throw InputError(
        fmt::format("calibration needs at least {} motion segments, got {}", settings.min_segments, pairs.size()));
  }
  const Vector6 before{T_body_lidar_before.x, T_body_lidar_before.y, T_body_lidar_before.yaw, 1.0, 1.0, 0.0};
  const Vector6 max_std{settings.max_std_lidar_m,        settings.max_std_lidar_m,
                        settings.max_std_lidar_rad,      settings.max_std_distance_scale,
                        settings.max_std_rotation_scale, settings.max_std_steering_bias_rad_per_m};
  Calibrator calibrator(pairs, before, settings);
  CalibrationResult result;
  std::array<bool, kNumParameters> is_fixed{};
  for (std::size_t i = 0; i < kNumParameters; ++i) is_fixed[i] = max_std[static_cast<Eigen::Index>(i)] == 0.0;
  while (true) {
    calibrator.solve(is_fixed);
    const std::optional<std::size_t> worst = find_worst(calibrator.curvature_covariance(is_fixed), max_std, is_fixed);
    if (!worst) break;
    const auto row = static_cast<Eigen::Index>(*worst);
    result.parameters[*worst].std = std::sqrt(calibrator.curvature_covariance(is_fixed)(row, row));
    is_fixed[*worst] = true;
  }
  result.covariance = calibrator.covariance(is_fixed);
  for (std::size_t i = 0; i < kNumParameters; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    CalibratedParameter& parameter = result.parameters[i];
    parameter.before = before[row];
    parameter.value = calibrator.parameters()[row];
    parameter.is_observable = !is_fixed[i];
    if (parameter.is_observable) parameter.std = std::sqrt(result.covariance(row, row));
  }
  result.num_segments = static_cast<int>(pairs.size());
  result.errors = calibrator.distances();
  result.num_rejected = static_cast<int>(std::count_if(result.errors.begin(), result.errors.end(),
                                                       [&](double error) { return error >= settings.outlier_sigma; }));
  result.translation_noise_scale = calibrator.translation_noise_scale();
  result.rotation_noise_scale = calibrator.rotation_noise_scale();
  result.iterations = calibrator.iterations();
  result.converged = calibrator.converged();
  return result;
}

}  // namespace patrol::slam
