#include "localize/body_estimator.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::localize {
namespace {

constexpr double kMaxStartAcceleration_mps2 = 1.0;  // the start's tilt is read from gravity alone
constexpr int kFrozenRepeats = 10;  // equal readings in a row while the legs move
constexpr double kMovingJoint_radps = 0.2;
constexpr Time kMaxContactAge = std::chrono::milliseconds(20);
constexpr Time kContactPatience = std::chrono::milliseconds(8);
constexpr Time kMaxImuStep = std::chrono::milliseconds(50);  // a longer gap is not integrated across
constexpr Time kLegSilence = std::chrono::milliseconds(100);
constexpr double kHoldStd_mps = 0.5;        // without legs the velocity is at least not this wrong
constexpr double kGeometricTrust = 0.1;     // weight of a foot that is only guessed to stand
constexpr double kHeightTime_s = 0.1;       // smoothing of the height above ground
constexpr double kAssumedRate_hz = 1000.0;  // upper bound, for the size of the history
constexpr std::size_t kMaxPending = 256;

LegSample leg_sample(const JointState& joints) {
  LegSample sample{.stamp = joints.stamp};
  std::copy_n(joints.position_rad.begin(), 3 * kNumLegs, sample.angle_rad.data());
  std::copy_n(joints.velocity_radps.begin(), 3 * kNumLegs, sample.speed_radps.data());
  return sample;
}

bool is_complete(const JointState& joints) {
  return joints.position_rad.size() == 3 * kNumLegs && joints.velocity_radps.size() == 3 * kNumLegs;
}

InertialFilter::Settings filter_settings(const BodyEstimatorSettings& s) {
  return {.gyro_noise_radps_per_sqrt_hz = s.gyro_noise_radps_per_sqrt_hz,
          .gyro_bias_std_radps = s.gyro_bias_std_radps,
          .gyro_bias_walk_radps_per_sqrt_s = s.gyro_bias_walk_radps_per_sqrt_s,
          .accel_noise_mps2_per_sqrt_hz = s.accel_noise_mps2_per_sqrt_hz,
          .accel_bias_std_mps2 = s.accel_bias_std_mps2,
          .accel_bias_walk_mps2_per_sqrt_s = s.accel_bias_walk_mps2_per_sqrt_s,
          .way_std_m_per_sqrt_m = s.way_std_m_per_sqrt_m,
          .turn_std_rad_per_sqrt_rad = s.turn_std_rad_per_sqrt_rad};
}

Pose3 imu_pose(const RobotDescription& robot) {
  const auto imu = robot.T_body_sensor.find("imu");
  return imu == robot.T_body_sensor.end() ? Pose3{} : imu->second;
}

const BodyEstimatorSettings& checked(const BodyEstimatorSettings& settings) {
  validate(settings, "odometry");
  return settings;
}

}  // namespace

BodyEstimator::BodyEstimator(const RobotDescription& robot, const BodyEstimatorSettings& settings)
    : robot_(robot),
      settings_(checked(settings)),
      imu_mount_(imu_pose(robot)),
      history_(static_cast<std::size_t>(settings.history_s * kAssumedRate_hz)),
      contact_({.touch_n = settings.touch_force_n,
                .release_n = settings.release_force_n,
                .full_n = settings.full_force_n,
                .settle_s = settings.contact_settle_s}),
      bias_meter_({.window_s = settings.standstill_window_s,
                   .gyro_noise_radps_per_sqrt_hz = settings.gyro_noise_radps_per_sqrt_hz,
                   .foot_std_m = settings.standstill_foot_std_m}) {
  if (robot.legs.size() != kNumLegs) {
    throw InputError(
        fmt::format("robot {} has {} legs: leg odometry needs {}", robot.name, robot.legs.size(), kNumLegs));
  }
  pending_.reserve(kMaxPending);
}

void BodyEstimator::add(const Imu& imu) {
  Eigen::Matrix<double, 3 * kNumLegs, 1> reading = Eigen::Matrix<double, 3 * kNumLegs, 1>::Zero();
  reading.head<6>() << imu.angular_velocity_radps, imu.linear_acceleration_mps2;
  if (!is_plausible(imu) || (imu_repeats_.is_frozen(reading) && joints_move_) ||
      (filter_ && imu.stamp <= now_)) {
    ++rejected_messages_;
    return;
  }
  advance(imu.stamp, imu_mount_.to_body(imu));
  take_pending();
}

void BodyEstimator::add(const JointState& joints) {
  if (!is_complete(joints) || pending_.size() >= kMaxPending) {
    ++rejected_messages_;
    return;
  }
  LegSample sample = leg_sample(joints);
  const bool is_moving = sample.speed_radps.cwiseAbs().maxCoeff() > kMovingJoint_radps;
  const bool is_frozen = joint_repeats_.is_frozen(sample.angle_rad.reshaped()) && is_moving;
  if (!sample.angle_rad.allFinite() || !sample.speed_radps.allFinite() || is_frozen) {
    ++rejected_messages_;
    return;
  }
  joints_move_ = is_moving;
  if (last_contacts_ && *last_contacts_ >= sample.stamp) sample.trust = trust_;
  const auto place = std::upper_bound(pending_.begin(), pending_.end(), sample.stamp,
                                      [](Time stamp, const LegSample& other) { return stamp < other.stamp; });
  pending_.insert(place, sample);
  take_pending();
}

void BodyEstimator::add(const FootContacts& contacts) {
  const bool is_finite = std::all_of(contacts.force_n.begin(), contacts.force_n.end(),
                                     [](double f) { return std::isfinite(f); });
  if (contacts.force_n.size() != kNumLegs || !is_finite ||
      (last_contacts_ && contacts.stamp <= *last_contacts_)) {
    ++rejected_messages_;
    return;
  }
  std::array<double, kNumLegs> force_n{};
  std::copy_n(contacts.force_n.begin(), kNumLegs, force_n.begin());
  Eigen::Matrix<double, 3 * kNumLegs, 1> reading = Eigen::Matrix<double, 3 * kNumLegs, 1>::Zero();
  reading.head<kNumLegs>() = Eigen::Map<const Eigen::Vector4d>(force_n.data());
  if (contact_repeats_.is_frozen(reading) && joints_move_) {
    ++rejected_messages_;
    return;
  }
  trust_ = contact_.update(contacts.stamp, force_n);
  last_contacts_ = contacts.stamp;
  for (LegSample& sample : pending_) {
    if (!sample.trust && sample.stamp <= contacts.stamp) sample.trust = trust_;
  }
  take_pending();
}

// A living sensor never reads the same many times over while the robot moves.
bool BodyEstimator::Repeats::is_frozen(const Eigen::Matrix<double, 3 * kNumLegs, 1>& reading) {
  count = reading == last ? count + 1 : 0;
  last = reading;
  return count >= kFrozenRepeats;
}

void BodyEstimator::advance(Time stamp, const InertialSample& sample) {
  if (!filter_) {
    if (std::abs(sample.force_mps2.norm() - kGravity_mps2) > kMaxStartAcceleration_mps2) return;
    filter_.emplace(filter_settings(settings_), sample);
  } else if (stamp - now_ > kMaxImuStep) {
    filter_->coast(to_seconds(stamp - now_), filter_->yaw_rate_radps());
  } else {
    filter_->predict(to_seconds(stamp - now_), sample);
  }
  now_ = stamp;
  imu_is_silent_ = false;
  remember();
  if (last_leg_update_ && now_ - *last_leg_update_ > kLegSilence) hold_velocity();
}

// Readings of the legs are due once the IMU has passed their instant and the forces of that instant are known
// or late.
void BodyEstimator::take_pending() {
  if (!filter_) {
    pending_.clear();
    return;
  }
  std::size_t taken = 0;
  while (taken < pending_.size()) {
    LegSample& sample = pending_[taken];
    const bool imu_is_late = to_seconds(pending_.back().stamp - sample.stamp) > settings_.imu_patience_s;
    if (sample.stamp > now_ && !imu_is_late) break;
    if (!sample.trust) {
      if (std::max(now_, pending_.back().stamp) - sample.stamp < kContactPatience) break;
      if (last_contacts_ && sample.stamp - *last_contacts_ < kMaxContactAge) sample.trust = trust_;
    }
    if (sample.stamp > now_) coast_to(sample);
    use_legs(sample);
    ++taken;
  }
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(taken));
}

void BodyEstimator::coast_to(const LegSample& sample) {
  imu_is_silent_ = true;
  bias_meter_.reset();
  filter_->coast(to_seconds(sample.stamp - now_),
                 yaw_rate_by_feet(stance_feet(sample)).value_or(filter_->yaw_rate_radps()));
  now_ = sample.stamp;
  remember();
}

void BodyEstimator::use_legs(const LegSample& sample) {
  const std::optional<TrunkMotion> then = history_.motion_at(sample.stamp);
  if (!then) {
    ++rejected_messages_;
    return;
  }
  contacts_are_silent_ = !sample.trust;
  const StanceFeet feet = stance_feet(sample);
  const std::optional<LegVelocity> legs = fuse_feet(
      feet, then->omega_body, then->v_body, settings_.foot_velocity_std_mps, settings_.slip_speed_mps);
  if (!legs) return;
  slips_ += static_cast<std::uint64_t>(legs->num_slipping);
  filter_->correct_velocity(legs->v_body - then->v_body, legs->p_contact, legs->variance);
  measure_standstill(sample, *then, feet);

  const double height = *height_by_feet(feet, filter_->up_in_body());
  const double dt_s = last_leg_update_ ? to_seconds(sample.stamp - *last_leg_update_) : kHeightTime_s;
  height_m_ += std::clamp(dt_s / kHeightTime_s, 0.0, 1.0) * (height - height_m_);
  last_leg_update_ = std::max(last_leg_update_.value_or(sample.stamp), sample.stamp);
  remember();
}

StanceFeet BodyEstimator::stance_feet(const LegSample& sample) const {
  if (!sample.trust) return lowest_feet(sample);
  StanceFeet feet;
  const Eigen::Vector3d up = filter_->up_in_body();
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const double trust = (*sample.trust)[leg];
    if (trust <= 0.0) continue;
    StanceFoot foot = stance_foot(robot_.legs[leg], static_cast<int>(leg), sample, up);
    foot.weight = trust;
    feet.push_back(foot);
  }
  return feet;
}

// Without foot sensors.
StanceFeet BodyEstimator::lowest_feet(const LegSample& sample) const {
  const Eigen::Vector3d up = filter_->up_in_body();
  StanceFeet all, lowest;
  double ground = 0.0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    all.push_back(stance_foot(robot_.legs[static_cast<std::size_t>(leg)], leg, sample, up));
    ground = std::min(ground, all.feet[static_cast<std::size_t>(leg)].p_contact.dot(up));
  }
  for (StanceFoot foot : all) {
    if (foot.p_contact.dot(up) - ground > settings_.geometric_stance_m) continue;
    foot.weight = kGeometricTrust;
    lowest.push_back(foot);
  }
  return lowest;
}

void BodyEstimator::measure_standstill(const LegSample& sample, const TrunkMotion& then,
                                       const StanceFeet& feet) {
  if (imu_is_silent_ || !sample.trust || feet.count < kNumLegs) {
    bias_meter_.reset();
    return;
  }
  const Eigen::Vector3d gyro = then.omega_body + filter_->gyro_bias_radps();
  if (const auto reading = bias_meter_.add(sample.stamp, feet, gyro)) {
    filter_->correct_gyro_bias(reading->bias_radps, reading->variance);
  }
}

// By the IMU alone the velocity would run away; a walking robot's does not.
void BodyEstimator::hold_velocity() {
  if (now_ - last_velocity_hold_ < kLegSilence) return;
  last_velocity_hold_ = now_;
  filter_->correct_velocity(-filter_->motion().v_body, Eigen::Vector3d::Zero(), kHoldStd_mps * kHoldStd_mps);
  remember();
}

std::optional<OdometryEstimate> BodyEstimator::estimate() const {
  if (!filter_ || !last_leg_update_) return std::nullopt;
  const TrunkMotion& motion = filter_->motion();
  return OdometryEstimate{.stamp = now_,
                          .T_odom_body = motion.T_odom_body,
                          .twist = {.linear = motion.v_body, .angular = motion.omega_body},
                          .planar_covariance = filter_->planar_covariance()};
}

std::optional<Pose3> BodyEstimator::T_odom_body_at(Time stamp) const {
  if (history_.empty()) return std::nullopt;
  if (stamp <= history_.newest()) return history_.pose_at(stamp);
  const double ahead_s = to_seconds(stamp - history_.newest());
  if (ahead_s > settings_.extrapolation_s) return std::nullopt;
  // Straight on, turning about the vertical: the wobble of a walk does not carry on.
  const TrunkMotion& motion = history_.newest_motion();
  const Eigen::Quaterniond& rotation = motion.T_odom_body.rotation;
  const double yaw_rate = (rotation * motion.omega_body).z();
  return Pose3{motion.T_odom_body.position + ahead_s * (rotation * motion.v_body),
               quaternion_from_yaw(ahead_s * yaw_rate) * rotation};
}

EstimatorHealth BodyEstimator::health() const {
  EstimatorHealth health{.imu_is_silent = imu_is_silent_,
                         .contacts_are_silent = contacts_are_silent_,
                         .rejected_messages = rejected_messages_,
                         .slips = slips_};
  health.legs_are_silent = !last_leg_update_ || now_ - *last_leg_update_ > kLegSilence;
  if (filter_) {
    constexpr int kZ = InertialFilter::kGyroBias + 2;
    health.gyro_z_bias_std_radps = std::sqrt(filter_->covariance()(kZ, kZ));
  }
  return health;
}

}  // namespace patrol::localize
