#include "localize/registration/register_to_site.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "core/overloaded.h"

namespace patrol::localize {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kConvergence = 1e-12;  // step size, m and rad

using Delays = std::map<int, double>;  // [anchor number], m

/// Residual in standard deviations and its Jacobian with respect to x, y, yaw of T_site_map; unused rows are zero.
struct Residual {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  Eigen::Vector3d J_delay = Eigen::Vector3d::Zero();  ///< derivative by the delay of the anchor; zero without one
  int size = 0;
};

Eigen::Vector2d rotated_left(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

Residual residual_of(const AntennaPosition& fix, const Pose2& T_map_body, const Pose2& T_site_map, double map_std_m) {
  const Eigen::Vector2d p_site = T_site_map * (T_map_body * fix.p_level_antenna);
  const double std_m = std::hypot(fix.std_m, map_std_m);
  Residual residual{.size = 2};
  residual.r.head<2>() = (p_site - fix.p_site_antenna) / std_m;
  residual.J.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() / std_m;
  residual.J.col(2).head<2>() = rotated_left(p_site - T_site_map.position()) / std_m;
  return residual;
}

Residual residual_of(const AnchorRange& range, const Pose2& T_map_body, const Pose2& T_site_map, double map_std_m,
                     const UwbCalibration& calibration, double delay_m) {
  const Pose2 T_site_body = T_site_map * T_map_body;
  const PredictedRange predicted =
      predict_uwb_range(range.anchor_in_site, T_site_body, range.p_level_antenna, calibration);
  const double std_m = std::hypot(range.std_m, map_std_m);
  const Eigen::Vector2d lever = rotated_left(T_site_body.position() - T_site_map.position());
  Residual residual{.size = 1};
  residual.r[0] = (predicted.range_m + delay_m - range.range_m) / std_m;
  residual.J_delay[0] = 1.0 / std_m;
  residual.J.row(0) = predicted.H_pose.transpose() / std_m;
  residual.J(0, 2) += predicted.H_pose.head<2>().dot(lever) / std_m;
  return residual;
}

Residual residual_of(const SurveyedPose& pose, const Pose2& T_map_body, const Pose2& T_site_map, double map_std_m) {
  const Pose2 T_site_body = T_site_map * T_map_body;
  const double std_m = std::hypot(pose.position_std_m, map_std_m);
  Residual residual{.size = 3};
  residual.r.head<2>() = (T_site_body.position() - pose.T_site_body.position()) / std_m;
  residual.r[2] = wrap_angle(T_site_body.yaw - pose.T_site_body.yaw) / pose.yaw_std_rad;
  residual.J.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() / std_m;
  residual.J.col(2).head<2>() = rotated_left(T_site_body.position() - T_site_map.position()) / std_m;
  residual.J(2, 2) = 1.0 / pose.yaw_std_rad;
  return residual;
}

/// Part of the normal equations of the delay of one anchor. A measurement contains one delay at most, so that delays
/// have no information in common.
struct DelayEquation {
  double information = 0.0;  ///< information of the delay, with its prior
  double gradient = 0.0;
  Eigen::Vector3d cross_information = Eigen::Vector3d::Zero();  ///< cross information of the delay and the pose
};

/// Normal equations of the robust problem at a linearization point.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< information without the prior of the pose
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  std::map<int, DelayEquation> delays;
  double squares = 0.0;  ///< weighted sum of squared residuals
  double count = 0.0;    ///< weighted number of residuals

  /// Eliminates the delays (Schur complement).
  void reduce() {
    for (const auto& [anchor, delay] : delays) {
      information -= delay.cross_information * delay.cross_information.transpose() / delay.information;
      gradient -= delay.cross_information * (delay.gradient / delay.information);
    }
  }
};

int anchor_of(const SiteMeasurement& measurement) {
  const auto* range = std::get_if<AnchorRange>(&measurement.content);
  return range ? range->anchor_in_site.number : 0;
}

class Problem {
 public:
  Problem(std::span<const SiteMeasurement> measurements, const RegistrationSettings& settings,
          const UwbCalibration& calibration)
      : measurements_(measurements), settings_(settings), calibration_(calibration) {
    std::map<int, std::size_t> last;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const SiteMeasurement& measurement = measurements[i];
      const auto [before, is_first] = last.try_emplace(measurement.source, i);
      previous_.push_back(before->second);
      const double age_s = to_seconds(measurement.stamp - measurements[before->second].stamp);
      const double time_s = measurement.correlation_time_s;
      correlation_.push_back(is_first || time_s <= 0.0 ? 0.0 : std::min(std::exp(-age_s / time_s), kMaxCorrelation));
      before->second = i;
    }
  }

  /// Delays of zero of all anchors that have been measured.
  Delays no_delays() const {
    Delays delays;
    for (const SiteMeasurement& measurement : measurements_) {
      if (std::holds_alternative<AnchorRange>(measurement.content)) delays[anchor_of(measurement)] = 0.0;
    }
    return delays;
  }

  NormalEquations linearize(const Pose2& T_site_map, const Delays& delays, double scale) const {
    std::vector<Residual> residuals;
    residuals.reserve(measurements_.size());
    for (const SiteMeasurement& measurement : measurements_)
      residuals.push_back(residual(measurement, T_site_map, delays));
    NormalEquations sum;
    const double prior = 1.0 / (settings_.anchor_delay_std_m * settings_.anchor_delay_std_m);
    for (const auto& [anchor, delay_m] : delays)
      sum.delays[anchor] = {.information = prior, .gradient = prior * delay_m};
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const Residual& before = residuals[previous_[i]];
      const double phi = correlation_[i], white = std::sqrt(1.0 - phi * phi);
      const Eigen::Vector3d e = (residuals[i].r - phi * before.r) / white;
      const Eigen::Matrix3d J = (residuals[i].J - phi * before.J) / white;
      const Eigen::Vector3d J_delay = (residuals[i].J_delay - phi * before.J_delay) / white;
      const double weight = 1.0 / (1.0 + e.squaredNorm() / (scale * scale));
      if (const auto delay = sum.delays.find(anchor_of(measurements_[i])); delay != sum.delays.end()) {
        delay->second.information += weight * J_delay.squaredNorm();
        delay->second.gradient += weight * J_delay.dot(e);
        delay->second.cross_information += weight * J.transpose() * J_delay;
      }
      sum.information += weight * J.transpose() * J;
      sum.gradient += weight * J.transpose() * e;
      sum.squares += weight * e.squaredNorm();
      sum.count += weight * residuals[i].size;
    }
    return sum;
  }

 private:
  static constexpr double kMaxCorrelation = 0.999;  // bound for measurements of equal stamps

  Residual residual(const SiteMeasurement& measurement, const Pose2& T_site_map, const Delays& delays) const {
    const Pose2& T_map_body = measurement.T_map_body;
    const double map_std_m = settings_.map_std_m;
    return std::visit(
        Overloaded{[&](const AnchorRange& range) {
                     return residual_of(range, T_map_body, T_site_map, map_std_m, calibration_,
                                        delays.at(range.anchor_in_site.number));
                   },
                   [&](const auto& content) { return residual_of(content, T_map_body, T_site_map, map_std_m); }},
        measurement.content);
  }

  std::span<const SiteMeasurement> measurements_;
  const RegistrationSettings& settings_;
  const UwbCalibration& calibration_;
  std::vector<std::size_t> previous_;  ///< previous measurement of the same source; itself for the first
  std::vector<double> correlation_;    ///< correlation with the previous measurement
};

Eigen::Matrix3d inverse(const Eigen::Matrix3d& A) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) result.col(i) = solve_symmetric(A, Eigen::Vector3d(Eigen::Vector3d::Unit(i)));
  return 0.5 * (result + result.transpose());
}

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) { return {a.x - b.x, a.y - b.y, wrap_angle(a.yaw - b.yaw)}; }

}  // namespace

SitePoseGaussian registration_prior(const Pose2& T_site_start, const RegistrationSettings& settings) {
  const double position_m = settings.start_position_std_m, yaw_rad = to_rad(settings.start_yaw_std_deg);
  return {.T_site_map = T_site_start,
          .covariance =
              Eigen::Vector3d(position_m * position_m, position_m * position_m, yaw_rad * yaw_rad).asDiagonal()};
}

SitePoseGaussian register_to_site(const SitePoseGaussian& prior, std::span<const SiteMeasurement> measurements,
                                  const RegistrationSettings& settings, const UwbCalibration& calibration) {
  const Problem problem(measurements, settings, calibration);
  const Eigen::Matrix3d prior_information = inverse(prior.covariance);
  Pose2 T = prior.T_site_map;
  Delays delays = problem.no_delays();
  NormalEquations equations;
  for (const double widening : {64.0, 16.0, 4.0, 1.0}) {
    const double scale = widening * settings.outlier_scale_sigma;
    for (int i = 0; i < kMaxIterations; ++i) {
      equations = problem.linearize(T, delays, scale);
      equations.reduce();
      const Eigen::Matrix3d information = equations.information + prior_information;
      const Eigen::Vector3d gradient = equations.gradient + prior_information * difference(T, prior.T_site_map);
      const Eigen::Vector3d step = -solve_symmetric(information, gradient);
      T = {T.x + step.x(), T.y + step.y(), wrap_angle(T.yaw + step.z())};
      for (const auto& [anchor, delay] : equations.delays)
        delays[anchor] -= (delay.gradient + delay.cross_information.dot(step)) / delay.information;
      if (step.norm() < (widening > 1.0 ? 1e-4 : kConvergence)) break;
    }
  }
  constexpr int kSize = 3;
  const double ratio = equations.count > kSize ? equations.squares / (equations.count - kSize) : 1.0;
  return {.T_site_map = T, .covariance = inverse(equations.information / std::max(1.0, ratio) + prior_information)};
}

}  // namespace patrol::localize
