#include "localize/legged_odometry.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::localize {
namespace {

constexpr double kMovingJoint_radps = 0.2;
constexpr Time kMaxContactAge = std::chrono::milliseconds(20);
constexpr Time kContactTimeout = std::chrono::milliseconds(8);
constexpr Time kLegTimeout = std::chrono::milliseconds(100);
constexpr double kLegVelocityLimitStd_mps = 0.5;  // bound on the velocity error without legs
constexpr double kGeometricWeight = 0.1;          // weight of a stance foot selected by its height
constexpr double kHeightTime_s = 0.1;             // smoothing of the height above ground

LegSample leg_sample(const JointState& joints) {
  LegSample sample{.stamp = joints.stamp};
  std::copy_n(joints.position_rad.begin(), 3 * kNumLegs, sample.angle_rad.data());
  std::copy_n(joints.velocity_radps.begin(), 3 * kNumLegs, sample.speed_radps.data());
  return sample;
}

bool has_all_joints(const JointState& joints) {
  return joints.position_rad.size() == 3 * kNumLegs && joints.velocity_radps.size() == 3 * kNumLegs;
}

InertialFilter::Settings filter_settings(const LeggedOdometrySettings& s) {
  return {.gyro_noise_density_radps_per_sqrt_hz = s.gyro_noise_density_radps_per_sqrt_hz,
          .gyro_bias_std_radps = s.gyro_bias_std_radps,
          .gyro_bias_random_walk_radps_per_sqrt_s = s.gyro_bias_random_walk_radps_per_sqrt_s,
          .accel_noise_density_mps2_per_sqrt_hz = s.accel_noise_density_mps2_per_sqrt_hz,
          .accel_bias_std_mps2 = s.accel_bias_std_mps2,
          .accel_bias_random_walk_mps2_per_sqrt_s = s.accel_bias_random_walk_mps2_per_sqrt_s,
          .position_random_walk_m_per_sqrt_m = s.position_random_walk_m_per_sqrt_m,
          .yaw_random_walk_rad_per_sqrt_rad = s.yaw_random_walk_rad_per_sqrt_rad};
}

Pose3 imu_pose(const RobotDescription& robot) {
  const auto imu = robot.T_body_sensor.find("imu");
  return imu == robot.T_body_sensor.end() ? Pose3{} : imu->second;
}

const LeggedOdometrySettings& checked(const LeggedOdometrySettings& settings) {
  validate(settings, "odometry.legged");
  return settings;
}

}  // namespace

LeggedOdometry::LeggedOdometry(const RobotDescription& robot, const LeggedOdometrySettings& settings)
    : robot_(robot),
      settings_(checked(settings)),
      imu_(imu_pose(robot),
           {.standstill = {.window_s = settings.standstill_window_s,
                           .gyro_noise_density_radps_per_sqrt_hz = settings.gyro_noise_density_radps_per_sqrt_hz,
                           .foot_std_m = settings.standstill_foot_std_m},
            .buffer_s = settings.buffer_s,
            .max_extrapolation_s = settings.max_extrapolation_s}),
      contact_({.contact_on_n = settings.contact_on_force_n,
                .contact_off_n = settings.contact_off_force_n,
                .full_weight_n = settings.full_weight_force_n,
                .settling_time_s = settings.contact_settling_time_s}) {
  if (robot.legs.size() != kNumLegs) {
    throw InputError(
        fmt::format("robot {}: {} legs: legged odometry requires {}", robot.name, robot.legs.size(), kNumLegs));
  }
}

void LeggedOdometry::add(const Imu& imu) {
  const std::optional<InertialSample> sample = imu_.accept(imu, joints_move_);
  if (!sample) return;
  advance(imu.stamp, *sample);
  process_pending();
}

void LeggedOdometry::add(const JointState& joints) {
  if (!has_all_joints(joints) || pending_.is_full()) {
    imu_.reject();
    return;
  }
  LegSample sample = leg_sample(joints);
  const bool is_moving = sample.speed_radps.cwiseAbs().maxCoeff() > kMovingJoint_radps;
  const bool is_frozen = frozen_joints_.is_frozen(sample.angle_rad.reshaped()) && is_moving;
  if (!sample.angle_rad.allFinite() || !sample.speed_radps.allFinite() || is_frozen) {
    imu_.reject();
    return;
  }
  joints_move_ = is_moving;
  if (last_contacts_ && *last_contacts_ >= sample.stamp) sample.weights = contact_weights_;
  pending_.insert(sample);
  process_pending();
}

void LeggedOdometry::add(const FootContacts& contacts) {
  const bool is_finite =
      std::all_of(contacts.force_n.begin(), contacts.force_n.end(), [](double f) { return std::isfinite(f); });
  if (contacts.force_n.size() != kNumLegs || !is_finite || (last_contacts_ && contacts.stamp <= *last_contacts_)) {
    imu_.reject();
    return;
  }
  std::array<double, kNumLegs> force_n{};
  std::copy_n(contacts.force_n.begin(), kNumLegs, force_n.begin());
  if (frozen_contacts_.is_frozen(Eigen::Map<const Eigen::Vector4d>(force_n.data())) && joints_move_) {
    imu_.reject();
    return;
  }
  contact_weights_ = contact_.update(contacts.stamp, force_n);
  last_contacts_ = contacts.stamp;
  for (LegSample& sample : pending_) {
    if (!sample.weights && sample.stamp <= contacts.stamp) sample.weights = contact_weights_;
  }
  process_pending();
}

void LeggedOdometry::advance(Time stamp, const InertialSample& sample) {
  const auto make_filter = [this](const InertialSample& first) {
    return InertialFilter(filter_settings(settings_), first);
  };
  if (imu_.advance(stamp, sample, make_filter) == ImuFrontEnd<InertialFilter>::Step::kIgnored) return;
  imu_.remember();
  if (last_leg_update_ && imu_.now() - *last_leg_update_ > kLegTimeout) limit_velocity();
}

// A leg reading is due when the IMU has passed its stamp and the foot forces of that stamp have arrived or timed out.
void LeggedOdometry::process_pending() {
  if (!imu_.filter()) {
    pending_.clear();
    return;
  }
  while (!pending_.is_empty()) {
    LegSample sample = pending_.oldest();
    const Time newest = pending_.newest().stamp;
    const bool imu_is_late = to_seconds(newest - sample.stamp) > settings_.imu_timeout_s;
    if (sample.stamp > imu_.now() && !imu_is_late) return;
    if (!sample.weights) {
      if (std::max(imu_.now(), newest) - sample.stamp < kContactTimeout) return;
      if (last_contacts_ && sample.stamp - *last_contacts_ < kMaxContactAge) sample.weights = contact_weights_;
    }
    if (sample.stamp > imu_.now()) coast_to(sample);
    pending_.pop_oldest();
    use_legs(sample);
  }
}

void LeggedOdometry::coast_to(const LegSample& sample) {
  imu_.coast_to(sample.stamp, yaw_rate_from_feet(stance_feet(sample)).value_or(imu_.filter()->yaw_rate_radps()));
}

void LeggedOdometry::use_legs(const LegSample& sample) {
  const std::optional<TrunkMotion> then = imu_.motion_at(sample.stamp);
  if (!then) {
    imu_.reject();
    return;
  }
  contacts_timed_out_ = !sample.weights;
  const StanceFeet feet = stance_feet(sample);
  const std::optional<LegVelocity> legs =
      fuse_feet(feet, then->omega_body, then->v_body, settings_.foot_velocity_std_mps, settings_.slip_speed_mps);
  if (!legs) return;
  num_slips_ += static_cast<std::uint64_t>(legs->num_slipping);
  imu_.filter()->correct_velocity(legs->v_body - then->v_body, legs->p_contact, legs->variance);
  measure_standstill(sample, *then, feet);

  const double height = *height_from_feet(feet, imu_.filter()->up_in_body());
  const double dt_s = last_leg_update_ ? to_seconds(sample.stamp - *last_leg_update_) : kHeightTime_s;
  height_m_ += std::clamp(dt_s / kHeightTime_s, 0.0, 1.0) * (height - height_m_);
  last_leg_update_ = std::max(last_leg_update_.value_or(sample.stamp), sample.stamp);
  imu_.remember();
}

StanceFeet LeggedOdometry::stance_feet(const LegSample& sample) const {
  if (!sample.weights) return lowest_feet(sample);
  StanceFeet feet;
  const Eigen::Vector3d up = imu_.filter()->up_in_body();
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const double weights = (*sample.weights)[leg];
    if (weights <= 0.0) continue;
    StanceFoot foot = stance_foot(robot_.legs[leg], static_cast<int>(leg), sample, up);
    foot.weight = weights;
    feet.push_back(foot);
  }
  return feet;
}

// Fallback without foot sensors.
StanceFeet LeggedOdometry::lowest_feet(const LegSample& sample) const {
  const Eigen::Vector3d up = imu_.filter()->up_in_body();
  StanceFeet all, lowest;
  double ground = 0.0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    all.push_back(stance_foot(robot_.legs[static_cast<std::size_t>(leg)], leg, sample, up));
    ground = std::min(ground, all.feet[static_cast<std::size_t>(leg)].p_contact.dot(up));
  }
  for (StanceFoot foot : all) {
    if (foot.p_contact.dot(up) - ground > settings_.stance_height_tolerance_m) continue;
    foot.weight = kGeometricWeight;
    lowest.push_back(foot);
  }
  return lowest;
}

void LeggedOdometry::measure_standstill(const LegSample& sample, const TrunkMotion& then, const StanceFeet& feet) {
  if (imu_.has_timed_out() || !sample.weights || feet.count < kNumLegs) {
    imu_.bias_estimator().reset();
    return;
  }
  const Eigen::Vector3d gyro = then.omega_body + imu_.filter()->gyro_bias_radps();
  if (const auto reading = imu_.bias_estimator().add(sample.stamp, feet, gyro)) {
    imu_.filter()->correct_gyro_bias(reading->bias_radps, reading->variance);
  }
}

// The velocity of the IMU alone diverges; that of a walking robot is bounded.
void LeggedOdometry::limit_velocity() {
  if (!imu_.is_velocity_limit_due(kLegTimeout)) return;
  imu_.filter()->correct_velocity(-imu_.filter()->motion().v_body, Eigen::Vector3d::Zero(),
                                  kLegVelocityLimitStd_mps * kLegVelocityLimitStd_mps);
  imu_.remember();
}

std::optional<OdometryEstimate> LeggedOdometry::estimate() const {
  if (!imu_.filter() || !last_leg_update_) return std::nullopt;
  return imu_.estimate();
}

std::optional<Pose3> LeggedOdometry::T_odom_body_at(Time stamp) const { return imu_.T_odom_body_at(stamp); }

std::vector<CalibrationValue> LeggedOdometry::calibration() const {
  return imu_.calibration({.gyro_systematic_std_radps = settings_.gyro_bias_systematic_std_radps,
                           .accel_systematic_std_mps2 = settings_.accel_bias_systematic_std_mps2,
                           .accel_filter_prior_std_mps2 = settings_.accel_bias_std_mps2,
                           .accel_prior_std_mps2 = settings_.accel_bias_sheet_std_mps2,
                           .accel_scale_std = settings_.accel_scale_std});
}

EstimatorHealth LeggedOdometry::health() const {
  EstimatorHealth health{.imu_timed_out = imu_.has_timed_out(),
                         .contacts_timed_out = contacts_timed_out_,
                         .num_rejected_messages = imu_.num_rejected_messages(),
                         .num_slips = num_slips_};
  health.legs_timed_out = !last_leg_update_ || imu_.now() - *last_leg_update_ > kLegTimeout;
  if (imu_.filter()) {
    constexpr int kZ = InertialFilter::kGyroBias + 2;
    health.gyro_z_bias_std_radps = std::sqrt(imu_.filter()->covariance()(kZ, kZ));
  }
  return health;
}

}  // namespace patrol::localize
