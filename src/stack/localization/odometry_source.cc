#include "stack/localization/odometry_source.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "localize/legged_odometry.h"
#include "localize/map_pose_tracker.h"
#include "localize/track_odometry.h"

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

 private:
  localize::LeggedOdometry odometry_;
};

/// Odometry from IMU and the Hall counters of the tracks.
class TrackedOdometrySource final : public OdometrySource {
 public:
  TrackedOdometrySource(const RobotDescription& robot, const StackSettings& settings)
      : odometry_(robot, settings.odometry.tracked) {}

  void add(const SensorMessage& message) override {
    if (const auto* imu = std::get_if<Imu>(&message)) odometry_.add(*imu);
    if (const auto* ticks = std::get_if<TrackTicks>(&message)) odometry_.add(*ticks);
  }
  void correct_gyro_bias(double bias_radps, double std_radps) override {
    odometry_.correct_gyro_bias(bias_radps, std_radps);
  }
  std::optional<OdometryEstimate> estimate() const override { return odometry_.estimate(); }
  std::optional<Pose3> T_odom_body_at(Time stamp) const override { return odometry_.T_odom_body_at(stamp); }
  double height_above_ground_m() const override { return odometry_.height_above_ground_m(); }
  Eigen::Vector3d twist_std() const override { return odometry_.twist_std(); }
  std::vector<CalibrationValue> calibration() const override { return odometry_.calibration(); }

 private:
  localize::TrackOdometry odometry_;
};

}  // namespace

std::unique_ptr<OdometrySource> make_odometry_source(const StackSettings& settings, const RobotDescription& robot) {
  if (settings.odometry_source == "tracked") return std::make_unique<TrackedOdometrySource>(robot, settings);
  if (robot.legs.empty()) {
    throw InputError(
        fmt::format("stack.odometry_source = {}: robot {} has no legs", settings.odometry_source, robot.name));
  }
  return std::make_unique<LeggedOdometrySource>(robot, settings);
}

}  // namespace patrol::stack
