#include "studies/landmarks/ekf_slam.h"

#include <cmath>
#include <utility>

#include <Eigen/LU>

namespace patrol::studies {
namespace {

/// Rotation by 90 degrees: the derivative of a rotation at zero.
const Eigen::Matrix2d kQuarterRotation = (Eigen::Matrix2d() << 0.0, -1.0, 1.0, 0.0).finished();

/// Transforms p by the exponential of (dtheta, dp) on SE(2).
Eigen::Vector2d transformed(const Eigen::Vector2d& p, double dtheta, const Eigen::Vector2d& dp) {
  const double s = std::sin(dtheta), c = std::cos(dtheta);
  const double a = std::abs(dtheta) < 1e-9 ? 1.0 : s / dtheta,
               b = std::abs(dtheta) < 1e-9 ? 0.5 * dtheta : (1.0 - c) / dtheta;
  return {c * p.x() - s * p.y() + a * dp.x() - b * dp.y(), s * p.x() + c * p.y() + b * dp.x() + a * dp.y()};
}

}  // namespace

EkfSlam::EkfSlam(const EkfSlamSettings& settings, ControlMotion motion, const RangeBearingNoise& noise)
    : settings_(settings),
      motion_(std::move(motion)),
      noise_(noise),
      bias_(settings.bias),
      P_(Eigen::MatrixXd::Zero(kLandmarks, kLandmarks)) {
  motion_.std *= settings_.noise_scale;
  P_.block<2, 2>(kBias, kBias) = bias_.covariance;
}

LandmarkSlamEstimate EkfSlam::step(const Control& control, const std::vector<RangeBearing>& observations) {
  predict(control);
  for (const RangeBearing& observation : observations) {
    const auto number = static_cast<std::size_t>(observation.landmark);
    if (number < order_.size() && order_[number] != kUnmatched) correct(observation);
  }
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  for (const RangeBearing& observation : observations) {
    const auto number = static_cast<std::size_t>(observation.landmark);
    if (number >= order_.size() || order_[number] == kUnmatched) add_landmark(observation);
  }
  bias_.covariance = P_.block<2, 2>(kBias, kBias);
  return summary();
}

// Propagates the covariance: error after = F error before + G noise. F is the identity except for the columns of the
// heading (plain variant only) and of the bias.
void EkfSlam::predict(const Control& control) {
  const Control corrected = control + motion_.std.cwiseProduct(bias_.mean);
  const Eigen::Vector2d p_before = T_map_body_.position();
  const Eigen::Matrix<double, 3, 2> d_by_noise =
      jacobian_of(motion_, T_map_body_, corrected).control * motion_.std.asDiagonal();
  T_map_body_ = motion_.move(T_map_body_, corrected);
  const Eigen::Vector2d p = T_map_body_.position();

  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(P_.rows(), 2);
  G.row(kYaw) = d_by_noise.row(2);
  G.middleRows<2>(kPosition) = d_by_noise.topRows<2>();
  if (settings_.is_invariant) {
    G.middleRows<2>(kPosition) -= kQuarterRotation * p * d_by_noise.row(2);
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      G.middleRows<2>(kLandmarks + 2 * static_cast<Eigen::Index>(i)) =
          -kQuarterRotation * landmarks_[i] * d_by_noise.row(2);
    }
  } else {
    const Eigen::Vector2d d_by_yaw = kQuarterRotation * (p - p_before);
    P_.middleRows<2>(kPosition) += d_by_yaw * P_.row(kYaw);
    P_.middleCols<2>(kPosition) += P_.col(kYaw) * d_by_yaw.transpose();
  }
  if (settings_.bias.std > 0.0) {
    P_ += G * P_.middleRows<2>(kBias);
    P_ += P_.middleCols<2>(kBias).eval() * G.transpose();
    P_.block<2, 2>(kBias, kBias).diagonal().array() += settings_.bias.walk_std * settings_.bias.walk_std;
  }
  P_ += G * G.transpose();
}

void EkfSlam::correct(const RangeBearing& observation) {
  const auto index = static_cast<std::size_t>(order_[static_cast<std::size_t>(observation.landmark)]);
  const Eigen::Index row = kLandmarks + 2 * static_cast<Eigen::Index>(index);
  const PredictedObservation predicted = predict_observation(T_map_body_, landmarks_[index]);
  Eigen::MatrixXd PHt = (P_.middleCols<2>(row) - P_.middleCols<2>(kPosition)) * predicted.H_landmark.transpose();
  if (!settings_.is_invariant) PHt += P_.col(kYaw) * predicted.H_pose.col(2).transpose();
  Eigen::Matrix2d S =
      predicted.H_landmark * (PHt.middleRows<2>(row) - PHt.middleRows<2>(kPosition)) + noise_.covariance();
  if (!settings_.is_invariant) S += predicted.H_pose.col(2) * PHt.row(kYaw);
  const Eigen::MatrixXd K = PHt * S.inverse();
  apply(K * innovation_of(observation, predicted));
  P_.noalias() -= K * PHt.transpose();
}

void EkfSlam::apply(const Eigen::VectorXd& error) {
  const double dtheta = error(kYaw);
  bias_.mean += error.segment<2>(kBias);
  const auto corrected = [&](const Eigen::Vector2d& p, Eigen::Index row) -> Eigen::Vector2d {
    if (settings_.is_invariant) return transformed(p, dtheta, error.segment<2>(row));
    return p + error.segment<2>(row);
  };
  const Eigen::Vector2d p = corrected(T_map_body_.position(), kPosition);
  T_map_body_ = {p.x(), p.y(), wrap_angle(T_map_body_.yaw + dtheta)};
  for (std::size_t i = 0; i < landmarks_.size(); ++i)
    landmarks_[i] = corrected(landmarks_[i], kLandmarks + 2 * static_cast<Eigen::Index>(i));
}

void EkfSlam::add_landmark(const RangeBearing& observation) {
  const auto number = static_cast<std::size_t>(observation.landmark);
  if (number >= order_.size()) order_.resize(number + 1, kUnmatched);
  order_[number] = static_cast<int>(landmarks_.size());
  landmarks_.push_back(invert_observation(T_map_body_, observation));

  const Eigen::Matrix2d d_by_observation = predict_observation(T_map_body_, landmarks_.back()).H_landmark.inverse();
  const Eigen::Index n = P_.rows();
  Eigen::Matrix2Xd d_by_state = Eigen::Matrix2Xd::Zero(2, n);  // Jacobian of the new landmark's error
  d_by_state.middleCols<2>(kPosition).setIdentity();
  if (!settings_.is_invariant) d_by_state.col(kYaw) = kQuarterRotation * (landmarks_.back() - T_map_body_.position());
  const Eigen::Matrix2Xd cross = d_by_state * P_;
  const Eigen::Matrix2d own =
      cross * d_by_state.transpose() + d_by_observation * noise_.covariance() * d_by_observation.transpose();
  P_.conservativeResize(n + 2, n + 2);
  P_.bottomLeftCorner(2, n) = cross;
  P_.topRightCorner(n, 2) = cross.transpose();
  P_.bottomRightCorner<2, 2>() = own;
}

LandmarkSlamEstimate EkfSlam::summary() const {
  LandmarkSlamEstimate estimate{.T_map_body = T_map_body_};
  Eigen::Matrix3d d_by_error = Eigen::Matrix3d::Zero();  // Jacobian of x, y, yaw with respect to the rows yaw, x, y
  d_by_error(2, 0) = 1.0;
  d_by_error.topRightCorner<2, 2>().setIdentity();
  if (settings_.is_invariant) d_by_error.topLeftCorner<2, 1>() = kQuarterRotation * T_map_body_.position();
  estimate.covariance = d_by_error * P_.topLeftCorner<3, 3>() * d_by_error.transpose();
  return estimate;
}

std::vector<std::optional<Eigen::Vector2d>> EkfSlam::landmarks() const {
  std::vector<std::optional<Eigen::Vector2d>> found(order_.size());
  for (std::size_t number = 0; number < order_.size(); ++number) {
    if (order_[number] != kUnmatched) found[number] = landmarks_[static_cast<std::size_t>(order_[number])];
  }
  return found;
}

}  // namespace patrol::studies
