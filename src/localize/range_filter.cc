#include "localize/range_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::localize {
namespace {

constexpr int kFrozenRangeRepeats = 5;  // equal consecutive readings of one anchor, which noise practically excludes

const RangeFilterSettings& checked(const RangeFilterSettings& settings) {
  validate(settings, "uwb_filter");
  const std::vector<double>& distances = settings.bias_distance_m;
  if (distances.size() != settings.bias_m.size()) {
    throw InputError(
        fmt::format("uwb_filter.bias_m: {} values: must be {}, one per entry of uwb_filter.bias_distance_m",
                    settings.bias_m.size(), distances.size()));
  }
  if (std::adjacent_find(distances.begin(), distances.end(), std::greater_equal<>()) != distances.end()) {
    throw InputError("uwb_filter.bias_distance_m: must be strictly increasing");
  }
  return settings;
}

std::map<int, UwbAnchor> by_number(const std::vector<UwbAnchor>& anchors) {
  std::map<int, UwbAnchor> numbered;
  for (const UwbAnchor& anchor : anchors) {
    if (!numbered.emplace(anchor.number, anchor).second) {
      throw InputError(fmt::format("uwb anchor {}: duplicate number", anchor.number));
    }
  }
  return numbered;
}

double normal_density(double x, double std) {
  return std::exp(-0.5 * x * x / (std * std)) / (std * std::sqrt(2.0 * std::numbers::pi));
}

/// Returns the density of the sum of a normal and an exponential variable (exponentially modified Gaussian).
double nlos_density(double x, double std, double mean_bias) {
  const double exponent = 0.5 * std * std / (mean_bias * mean_bias) - x / mean_bias;
  const double tail = 0.5 * std::erfc((std / mean_bias - x / std) / std::numbers::sqrt2);
  return std::exp(std::min(exponent, 500.0)) * tail / mean_bias;
}

}  // namespace

RangeFilter::RangeFilter(const RangeFilterSettings& settings, const std::vector<UwbAnchor>& anchors_in_map,
                         Pose3 T_body_uwb)
    : settings_(checked(settings)),
      calibration_(settings.calibration()),
      anchors_(by_number(anchors_in_map)),
      T_body_uwb_(std::move(T_body_uwb)) {}

void RangeFilter::set_initial_pose(const PoseEstimate& start, const Pose3& T_odom_body, double z_m) {
  has_started_ = true;
  state_ = State{.stamp = start.stamp, .T_odom_body = T_odom_body, .T_map_body = start.T_map_body, .z_m = z_m};
  state_.P.topLeftCorner<3, 3>() = start.covariance;
  state_.P(kHeight, kHeight) = std::pow(settings_.start_height_std_m, 2);
  state_.P.bottomRightCorner<3, 3>().setIdentity();
  accepted_.clear();
}

void RangeFilter::set_anchors(const std::vector<UwbAnchor>& anchors_in_map) { anchors_ = by_number(anchors_in_map); }

void RangeFilter::predict(Time stamp, const Pose3& T_odom_body, const Eigen::Vector3d& twist_std) {
  if (!has_started_ || stamp <= state_.stamp) return;
  state_ = predicted(state_, stamp, T_odom_body, twist_std);
  twist_std_ = twist_std;
}

RangeFilter::State RangeFilter::predicted(State state, Time stamp, const Pose3& T_odom_body,
                                          const Eigen::Vector3d& twist_std) const {
  const double dt_s = to_seconds(stamp - state.stamp);
  const Pose2 step = to_pose2(state.T_odom_body).inverse() * to_pose2(T_odom_body);
  const double distance_m = step.position().norm(), turn_rad = std::abs(step.yaw);

  // Odometry increment, corrected by its estimated error.
  const Eigen::Vector3d drift_step = dt_s * twist_std.cwiseProduct(state.drift);
  const Pose2 before = state.T_map_body;
  state.T_map_body = before * Pose2{step.x + drift_step.x(), step.y + drift_step.y(), step.yaw + drift_step.z()};
  state.T_map_body.yaw = wrap_angle(state.T_map_body.yaw);
  state.z_m += T_odom_body.position.z() - state.T_odom_body.position.z();
  state.T_odom_body = T_odom_body;
  state.stamp = stamp;

  const Eigen::Vector2d went = state.T_map_body.position() - before.position();
  const Eigen::Vector3d keep(std::exp(-distance_m / settings_.longitudinal_correlation_m),
                             std::exp(-distance_m / settings_.lateral_correlation_m),
                             std::exp(-dt_s / settings_.yaw_correlation_s));
  Eigen::Matrix<double, kSize, kSize> F = Eigen::Matrix<double, kSize, kSize>::Identity();
  F(0, kYaw) = -went.y();
  F(1, kYaw) = went.x();
  F.block<2, 2>(0, kDrift) =
      dt_s * Eigen::Rotation2Dd(before.yaw).toRotationMatrix() * twist_std.head<2>().asDiagonal();
  F(kYaw, kDrift + 2) = dt_s * twist_std.z();
  F.bottomRightCorner<3, 3>() = keep.asDiagonal();
  state.drift = keep.cwiseProduct(state.drift);

  state.P = F * state.P * F.transpose();
  state.P.diagonal().head<2>().array() += distance_m * std::pow(settings_.position_random_walk_m_per_sqrt_m, 2);
  state.P(kYaw, kYaw) += dt_s * std::pow(settings_.yaw_random_walk_rad_per_sqrt_s, 2) +
                         turn_rad * std::pow(settings_.yaw_random_walk_rad_per_sqrt_rad, 2);
  state.P(kHeight, kHeight) += distance_m * std::pow(settings_.height_std_m_per_sqrt_m, 2);
  state.P.diagonal().tail<3>().array() += 1.0 - keep.array().square();
  return state;
}

RangeOutcome RangeFilter::add(const UwbRange& range, const Pose3& T_odom_body) {
  RangeOutcome outcome;
  if (!has_started_ || !is_usable(range)) return outcome;
  Vector H;
  outcome.innovation_m = innovation(range, T_odom_body, H);
  const double los_var = settings_.range_std_m * settings_.range_std_m;
  outcome.variance_m2 = H.dot(state_.P * H) + los_var;
  outcome.los_probability = los_probability(outcome.innovation_m, std::sqrt(outcome.variance_m2));
  outcome.status = classify(outcome);
  if (outcome.is_accepted()) correct(H, outcome.innovation_m, los_var / outcome.los_probability);
  count(outcome.is_accepted());
  return outcome;
}

bool RangeFilter::is_usable(const UwbRange& range) {
  if (!anchors_.contains(range.anchor) || !std::isfinite(range.range_m) || range.range_m < 0.0) return false;
  const auto [entry, is_new] = last_ranges_.try_emplace(range.anchor, LastRange{range.stamp, range.range_m, 0});
  LastRange& last = entry->second;
  if (is_new) return true;
  if (range.stamp <= last.stamp) return false;
  last.repeats = range.range_m == last.range_m ? last.repeats + 1 : 0;
  last.stamp = range.stamp;
  last.range_m = range.range_m;
  return last.repeats < kFrozenRangeRepeats;
}

double RangeFilter::innovation(const UwbRange& range, const Pose3& T_odom_body, Vector& H) const {
  const Pose2 since = to_pose2(state_.T_odom_body).inverse() * to_pose2(T_odom_body);
  const Pose2 T_map_then = state_.T_map_body * since;
  const double z_then = state_.z_m + T_odom_body.position.z() - state_.T_odom_body.position.z();
  const Eigen::Vector3d antenna = uwb_antenna_in_level(T_odom_body.rotation, T_body_uwb_, z_then);
  const PredictedRange expected = predict_uwb_range(anchors_.at(range.anchor), T_map_then, antenna, calibration_);
  // A heading error at the present pose rotates the motion back to the time of the range.
  const Eigen::Vector2d back = T_map_then.position() - state_.T_map_body.position();
  H.setZero();
  H.head<3>() = expected.H_pose;
  H[kYaw] += expected.H_pose.y() * back.x() - expected.H_pose.x() * back.y();
  H[kHeight] = expected.H_z;
  return range.range_m - expected.range_m;
}

double RangeFilter::los_probability(double innovation_m, double std_m) const {
  const double clear = (1.0 - settings_.nlos_probability) * normal_density(innovation_m, std_m);
  const double blocked = settings_.nlos_probability * nlos_density(innovation_m, std_m, settings_.nlos_bias_m);
  return clear + blocked > 0.0 ? clear / (clear + blocked) : 0.0;
}

RangeStatus RangeFilter::classify(const RangeOutcome& outcome) const {
  if (outcome.innovation_m < -settings_.negative_gate_sigma * std::sqrt(outcome.variance_m2))
    return RangeStatus::kTooShort;
  return outcome.los_probability < settings_.min_los_probability ? RangeStatus::kTooLong : RangeStatus::kAccepted;
}

void RangeFilter::correct(const Vector& H, double innovation_m, double variance_m2) {
  const Vector W = state_.P * H;
  const double S = H.dot(W) + variance_m2;
  const Vector shift = W * (innovation_m / S);
  state_.T_map_body.x += shift[0];
  state_.T_map_body.y += shift[1];
  state_.T_map_body.yaw = wrap_angle(state_.T_map_body.yaw + shift[kYaw]);
  state_.z_m += shift[kHeight];
  state_.drift += shift.tail<3>();
  state_.P -= W * W.transpose() / S;
  state_.P = (0.5 * (state_.P + state_.P.transpose())).eval();
}

void RangeFilter::count(bool is_accepted) {
  accepted_.push_back(is_accepted);
  if (static_cast<int>(accepted_.size()) > settings_.window) accepted_.pop_front();
  if (static_cast<int>(accepted_.size()) < settings_.window || accepted_ratio() >= settings_.min_accepted_ratio) return;
  ++num_resets_;
  accepted_.clear();
  state_.P.diagonal().head<2>().array() += settings_.reset_std_m * settings_.reset_std_m;
  state_.P(kYaw, kYaw) += settings_.reset_std_rad * settings_.reset_std_rad;
}

double RangeFilter::accepted_ratio() const {
  if (accepted_.empty()) return 1.0;
  return static_cast<double>(std::count(accepted_.begin(), accepted_.end(), true)) /
         static_cast<double>(accepted_.size());
}

PoseEstimate RangeFilter::estimate(Time stamp, const Pose3& T_odom_body) const {
  const State state = predicted(state_, std::max(stamp, state_.stamp), T_odom_body, twist_std_);
  return {.stamp = stamp, .T_map_body = state.T_map_body, .covariance = state.P.topLeftCorner<3, 3>()};
}

}  // namespace patrol::localize
