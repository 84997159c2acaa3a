#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"

/// Errors of sensors and drives that are constant over a run. The defaults are those of a nominal robot.
namespace patrol::sim {

/// Systematic errors of a lidar.
struct LidarErrors {
  double noise_ratio = 1.0;  ///< range noise relative to the sensor's settings
  double range_offset_m = 0.0;
  double range_scale = 0.0;     ///< relative range error
  double reflectivity_m = 0.0;  ///< range error on 10 % reflectivity relative to 50 %
  double incidence_m = 0.0;     ///< range error at grazing incidence relative to normal incidence
  double axis_tilt_x_rad = 0.0, axis_tilt_y_rad = 0.0;  ///< rotation of the axis in the housing, about x and y
  double cone_rad = 0.0;                                ///< elevation of the beams above the plane of rotation
  double rate_std = 0.0;                                ///< standard deviation of the relative revolution rate

  /// Returns the range error on a surface of the given reflectivity and cosine of the angle of incidence.
  double range_error_m(double range_m, double reflectivity, double cosine) const;
  /// Returns the direction in which a beam leaves the housing, in `lidar`, for its nominal direction.
  Eigen::Vector3d actual_direction(const Eigen::Vector3d& nominal) const;
};

/// Errors of direction of a lidar, for many beams: sine and cosine are computed once.
class LidarAim {
 public:
  explicit LidarAim(const LidarErrors& errors);
  /// Equal to `errors.actual_direction(nominal)` to the bit.
  Eigen::Vector3d operator()(const Eigen::Vector3d& nominal) const;

 private:
  bool is_ideal_;
  double axis_tilt_x_rad_, axis_tilt_y_rad_, cosine_, sine_;
};

/// Systematic errors of a triad of inertial sensors, in units of the readings.
struct TriadErrors {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_per_k = Eigen::Vector3d::Zero();
  Eigen::Matrix3d distortion = Eigen::Matrix3d::Zero();  ///< scale and misalignment, added to the identity
};

/// Systematic errors of an inertial measurement unit.
struct ImuErrors {
  TriadErrors gyro, accel;
  Eigen::Matrix3d g_sensitivity = Eigen::Matrix3d::Zero();  ///< gyro bias per specific force, rad/s per m/s^2
  double warming_k = 0.0;
  double warming_time_s = 1.0;

  /// Returns the rise of the sensor's temperature above that at power-up.
  double temperature_rise_k(Time now) const;
};

/// Errors of the joint encoders.
struct JointErrors {
  std::vector<double> zero_offset_rad;  ///< [joint]; empty: no errors
  std::vector<double> play_rad;         ///< total play between encoder and joint, as long as `zero_offset_rad`
};

/// Errors of a track drive.
struct TrackErrors {
  std::array<double, 2> sprocket_scale = {1.0, 1.0};  ///< pitch radius relative to the nominal one, left and right
  double friction_scale = 1.0;
  double missed_edge_probability = 0.0;
  double gauge_error_m = 0.0;  ///< actual minus nominal distance between the center lines of the tracks
};

/// Errors of the wheels of a robot.
struct WheelErrors {
  std::vector<double> radius_scale;  ///< [wheel]: radius relative to the nominal one; empty without errors
  double friction_scale = 1.0;
  double gauge_error_m = 0.0;  ///< actual minus nominal distance between the wheels of the two sides
};

/// Errors of a depth camera's calibration: published minus actual values.
struct DepthCameraErrors {
  double focal_scale = 1.0;          ///< published over actual focal length
  double cx_px = 0.0, cy_px = 0.0;   ///< errors of the principal point
  double inverse_depth_per_m = 0.0;  ///< error of the inverse depth
};

}  // namespace patrol::sim
