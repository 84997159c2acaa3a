#include "sim/as_built/sensor_errors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace patrol::sim {

double LidarErrors::range_error_m(double range_m, double reflectivity, double cosine) const {
  double error_m = range_offset_m + range_scale * range_m + incidence_m * (1.0 - cosine);
  if (reflectivity_m != 0.0) {
    // Range walk follows the logarithm of the returned light: 0 on 50 %, reflectivity_m on 10 %.
    error_m += reflectivity_m * std::log(0.5 / std::clamp(reflectivity, 0.02, 1.0)) / std::log(5.0);
  }
  return error_m;
}

Eigen::Vector3d LidarErrors::actual_direction(const Eigen::Vector3d& nominal) const { return LidarAim(*this)(nominal); }

LidarAim::LidarAim(const LidarErrors& errors)
    : is_ideal_(errors.cone_rad == 0.0 && errors.axis_tilt_x_rad == 0.0 && errors.axis_tilt_y_rad == 0.0),
      axis_tilt_x_rad_(errors.axis_tilt_x_rad),
      axis_tilt_y_rad_(errors.axis_tilt_y_rad),
      cosine_(std::cos(errors.cone_rad)),
      sine_(std::sin(errors.cone_rad)) {}

Eigen::Vector3d LidarAim::operator()(const Eigen::Vector3d& nominal) const {
  if (is_ideal_) return nominal;
  const double level = std::hypot(nominal.x(), nominal.y());
  const double raised = level * cosine_ - nominal.z() * sine_, height = nominal.z() * cosine_ + level * sine_;
  const double shrink = level > 0.0 ? raised / level : 0.0;
  const Eigen::Vector3d beam(shrink * nominal.x(), shrink * nominal.y(), height);
  return (beam + Eigen::Vector3d(axis_tilt_x_rad_, axis_tilt_y_rad_, 0.0).cross(beam)).normalized();
}

double ImuErrors::temperature_rise_k(Time now) const {
  return warming_k * (1.0 - std::exp(-to_seconds(now) / warming_time_s));
}

}  // namespace patrol::sim
