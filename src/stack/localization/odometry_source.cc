#include "stack/localization/odometry_source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "localize/legged_odometry.h"
#include "localize/localize_state.h"
#include "localize/map_pose_tracker.h"
#include "localize/steered_wheels.h"
#include "localize/track_odometry.h"
#include "localize/wheel_rows.h"

namespace patrol::stack {
namespace {

/// Odometry from IMU, joint encoders and foot forces.
class LeggedOdometrySource final : public OdometrySource {
 public:
  LeggedOdometrySource(const RobotDescription& robot, const StackSettings& settings)
      : odometry_(robot, settings.odometry.legged) {}

  void add(const SensorMessage& message) override {
    if (const auto* imu = std::get_if<Imu>(&message)) odometry_.add(*imu);
    if (const auto* joints = std::get_if<JointState>(&message)) odometry_.add(*joints);
    if (const auto* contacts = std::get_if<FootContacts>(&message)) odometry_.add(*contacts);
  }
  void correct_gyro_bias(double bias_radps, double std_radps) override {
    odometry_.correct_gyro_bias(bias_radps, std_radps);
  }
  std::optional<OdometryEstimate> estimate() const override { return odometry_.estimate(); }
  std::optional<Pose3> T_odom_body_at(Time stamp) const override { return odometry_.T_odom_body_at(stamp); }
  double height_above_ground_m() const override { return odometry_.height_above_ground_m(); }
  /// Uses the drift that the pose in map assumes between two corrections.
  Eigen::Vector3d twist_std() const override {
    const localize::OdometryDrift drift;
    const std::optional<OdometryEstimate> now = odometry_.estimate();
    if (!now) return Eigen::Vector3d::Zero();
    const double speed_mps = now->twist.linear.head<2>().norm(), yaw_rate_radps = std::abs(now->twist.angular.z());
    const double position_std_mps = drift.position_std_m_per_m * speed_mps;
    return {position_std_mps, position_std_mps,
            drift.yaw_std_rad_per_m * speed_mps + drift.yaw_std_rad_per_rad * yaw_rate_radps};
  }
  std::vector<CalibrationValue> calibration() const override { return odometry_.calibration(); }
  void serialize_state(StateArchive& archive) override { archive(odometry_); }

 private:
  localize::LeggedOdometry odometry_;
};

/// Odometry from IMU and the counters of tracks or wheels.
class DifferentialOdometrySource : public OdometrySource {
 public:
  DifferentialOdometrySource(const RobotDescription& robot, const localize::TrackOdometrySettings& settings)
      : odometry_(robot, settings) {}

  void add(const SensorMessage& message) override {
    if (const auto* imu = std::get_if<Imu>(&message)) odometry_.add(*imu);
    if (const auto ticks = ticks_of(message)) odometry_.add(*ticks);
  }
  void correct_gyro_bias(double bias_radps, double std_radps) override {
    odometry_.correct_gyro_bias(bias_radps, std_radps);
  }
  std::optional<OdometryEstimate> estimate() const override { return odometry_.estimate(); }
  std::optional<Pose3> T_odom_body_at(Time stamp) const override { return odometry_.T_odom_body_at(stamp); }
  double height_above_ground_m() const override { return odometry_.height_above_ground_m(); }
  Eigen::Vector3d twist_std() const override { return odometry_.twist_std(); }
  std::vector<CalibrationValue> calibration() const override { return odometry_.calibration(); }
  void serialize_state(StateArchive& archive) override { archive(odometry_); }

 private:
  /// Returns the counts of the two sides in a message; none if it has no counts.
  virtual std::optional<localize::DriveTicks> ticks_of(const SensorMessage& message) = 0;

  localize::TrackOdometry odometry_;
};

class TrackedOdometrySource final : public DifferentialOdometrySource {
 public:
  TrackedOdometrySource(const RobotDescription& robot, const StackSettings& settings)
      : DifferentialOdometrySource(robot, settings.odometry.tracked) {}

 private:
  std::optional<localize::DriveTicks> ticks_of(const SensorMessage& message) override {
    const auto* ticks = std::get_if<TrackTicks>(&message);
    return ticks ? std::optional<localize::DriveTicks>(*ticks) : std::nullopt;
  }
};

/// Returns the encoder reading in a message; none for another message, and for a reading that is not of all joints of
/// the robot or not finite.
const JointState* usable_joints(const SensorMessage& message, const RobotDescription& robot) {
  const auto* joints = std::get_if<JointState>(&message);
  if (!joints || joints->position_rad.size() != robot.joint_names.size()) return nullptr;
  return std::ranges::all_of(joints->position_rad, [](double rad) { return std::isfinite(rad); }) ? joints : nullptr;
}

/// The wheels of a side, which are not steered, count as one track.
class WheeledOdometrySource final : public DifferentialOdometrySource {
 public:
  WheeledOdometrySource(const RobotDescription& robot, const StackSettings& settings)
      : DifferentialOdometrySource(robot, settings.odometry.wheeled),
        robot_(robot),
        rows_(robot, settings.odometry.wheeled.ticks_per_sprocket_turn) {}

  void serialize_state(StateArchive& archive) override {
    DifferentialOdometrySource::serialize_state(archive);
    archive(rows_);
  }

 private:
  std::optional<localize::DriveTicks> ticks_of(const SensorMessage& message) override {
    if (const auto* imu = std::get_if<Imu>(&message)) rows_.add(*imu);
    const JointState* joints = usable_joints(message, robot_);
    return joints ? std::optional<localize::DriveTicks>(rows_.add(*joints)) : std::nullopt;
  }

  RobotDescription robot_;
  localize::WheelRows rows_;
};

/// The driven wheels are steered: they yield the motion of the axle that is not.
class SteeredOdometrySource final : public DifferentialOdometrySource {
 public:
  SteeredOdometrySource(const RobotDescription& robot, const localize::TrackOdometrySettings& settings)
      : DifferentialOdometrySource(robot, settings),
        robot_(robot),
        wheels_(robot, settings.ticks_per_sprocket_turn,
                settings.skid_ratio > 0.0 ? settings.skid_ratio : skid_ratio(robot)) {}

  void serialize_state(StateArchive& archive) override {
    DifferentialOdometrySource::serialize_state(archive);
    archive(wheels_);
  }

 private:
  std::optional<localize::DriveTicks> ticks_of(const SensorMessage& message) override {
    const JointState* joints = usable_joints(message, robot_);
    return joints ? std::optional<localize::DriveTicks>(wheels_.add(*joints)) : std::nullopt;
  }

  RobotDescription robot_;
  localize::SteeredWheels wheels_;
};

/// The angles of the four mecanum wheels yield a displacement in body (mecanum_motion): its forward part and its
/// rotation are the counts of the two sides.
class MecanumOdometrySource final : public DifferentialOdometrySource {
 public:
  MecanumOdometrySource(const RobotDescription& robot, const StackSettings& settings)
      : DifferentialOdometrySource(robot, settings.odometry.wheeled),
        robot_(robot),
        half_gauge_m_(0.5 * differential_geometry(robot).gauge_m * skid_ratio(robot)),
        ticks_per_m_(settings.odometry.wheeled.ticks_per_sprocket_turn /
                     (2.0 * std::numbers::pi * differential_geometry(robot).rolling_radius_m)) {}

 private:
  std::optional<localize::DriveTicks> ticks_of(const SensorMessage& message) override {
    const JointState* joints = usable_joints(message, robot_);
    if (!joints) return std::nullopt;
    const WheelMotion moved = mecanum_motion(robot_, joints->position_rad);
    const double turned_m = half_gauge_m_ * moved.velocity.z();
    return localize::DriveTicks(joints->stamp, to_ticks(moved.velocity.x() - turned_m),
                                to_ticks(moved.velocity.x() + turned_m), to_ticks(moved.velocity.y()),
                                to_ticks(moved.residual_mps));
  }
  std::int64_t to_ticks(double distance_m) const { return std::llround(distance_m * ticks_per_m_); }

  RobotDescription robot_;
  double half_gauge_m_, ticks_per_m_;
};

}  // namespace

std::unique_ptr<OdometrySource> make_odometry_source(const StackSettings& settings, const RobotDescription& robot) {
  if (settings.odometry_source == "tracked") {
    if (!robot.tracks)
      throw InputError(fmt::format("stack.odometry_source = tracked: robot {} has no tracks", robot.name));
    return std::make_unique<TrackedOdometrySource>(robot, settings);
  }
  if (settings.odometry_source == "wheeled" && has_rollers(robot))
    return std::make_unique<MecanumOdometrySource>(robot, settings);
  if (settings.odometry_source == "wheeled" && localize::is_driven_by_steered_wheels(robot))
    return std::make_unique<SteeredOdometrySource>(robot, settings.odometry.wheeled);
  if (settings.odometry_source == "wheeled") return std::make_unique<WheeledOdometrySource>(robot, settings);
  if (robot.legs.empty()) {
    throw InputError(
        fmt::format("stack.odometry_source = {}: robot {} has no legs", settings.odometry_source, robot.name));
  }
  return std::make_unique<LeggedOdometrySource>(robot, settings);
}

}  // namespace patrol::stack
