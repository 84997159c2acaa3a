#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/named_table.h"
#include "core/time.h"

/// Calibration parameters that the robot estimates while it drives, and the message with their estimates.
namespace patrol {

/// Parameter of the robot's calibration. `kCalibrationParameters` is the only table of their names.
enum class CalibrationParameter : std::uint8_t {
  kLidarTimeOffset,
  kLidarClockDrift,
  kLidarYaw,
  kOdometryDistanceScale,
  kOdometryRotationScale,
  kGyroZBias,
  kGyroZScale,
  kGyroXBias,
  kGyroYBias,
  kAccelXBias,
  kAccelYBias,
  kAccelZBias,
  kTurnCenterX,
  kTurnCenterY,
};

inline constexpr std::array kCalibrationParameters = std::to_array<NamedValue<CalibrationParameter>>({
    {CalibrationParameter::kLidarTimeOffset, "lidar.time_offset_s",
     "Lidar stamp minus odometry stamp of the same instant, at the stamp of the estimate; positive: stamps are late"},
    {CalibrationParameter::kLidarClockDrift, "lidar.clock_drift_s_per_s", "Change of the time offset per time"},
    {CalibrationParameter::kLidarYaw, "lidar.yaw_rad",
     "Actual minus nominal yaw of the lidar in the body, about its vertical axis"},
    {CalibrationParameter::kOdometryDistanceScale, "odometry.distance_scale", "Actual distance / odometry distance"},
    {CalibrationParameter::kOdometryRotationScale, "odometry.rotation_scale",
     "Actual yaw change / odometry yaw change"},
    {CalibrationParameter::kGyroZBias, "imu.gyro_z_bias_radps", "Gyro reading about the vertical at rest"},
    {CalibrationParameter::kGyroZScale, "imu.gyro_z_scale",
     "Actual yaw rate / gyro reading about the vertical, without the bias"},
    {CalibrationParameter::kGyroXBias, "imu.gyro_x_bias_radps", "Gyro reading about its x axis at rest"},
    {CalibrationParameter::kGyroYBias, "imu.gyro_y_bias_radps", "Gyro reading about its y axis at rest"},
    {CalibrationParameter::kAccelXBias, "imu.accel_x_bias_mps2",
     "Accelerometer reading minus specific force along its x axis; on level ground it is confounded with tilt"},
    {CalibrationParameter::kAccelYBias, "imu.accel_y_bias_mps2",
     "Accelerometer reading minus specific force along its y axis; on level ground it is confounded with tilt"},
    {CalibrationParameter::kAccelZBias, "imu.accel_z_bias_mps2",
     "Accelerometer reading minus specific force along its z axis"},
    {CalibrationParameter::kTurnCenterX, "odometry.turn_center_x_m",
     "x in body of the center of rotation of a tracked robot: mean of the instantaneous centers of the tracks"},
    {CalibrationParameter::kTurnCenterY, "odometry.turn_center_y_m",
     "y in body of the point of a tracked robot that moves at the mean speed of the tracks while it turns"},
});
static_assert(is_in_order(kCalibrationParameters));

constexpr std::string_view name_of(CalibrationParameter parameter) {
  return row_of(kCalibrationParameters, parameter).name;
}

/// Returns the name of the range delay of a UWB anchor: reading minus modeled reading in line of sight, m.
inline std::string anchor_delay_name(int anchor) { return "uwb.anchor_" + std::to_string(anchor) + ".delay_m"; }

/// Estimate of one parameter. A parameter that the motion has not constrained has the standard deviation of its prior.
struct CalibrationValue {
  std::string name;    ///< name in kCalibrationParameters, or anchor_delay_name
  double value = 0.0;  ///< unit as in the name; scales: 1 nominal
  double std = 0.0;    ///< standard deviation
};

/// Estimates of all calibration parameters.
struct CalibrationEstimate {
  Time stamp{};
  std::vector<CalibrationValue> values;
};

}  // namespace patrol
