#include "conversions.h"

#include <cmath>

#include "core/geometry/angles.h"

namespace mrpt_stack {

bool is_return(const patrol::LaserScan& scan, float range_m) {
  return std::isfinite(range_m) && range_m > scan.range_min_m && range_m < scan.range_max_m;
}

mrpt::obs::CObservation2DRangeScan to_mrpt(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar) {
  mrpt::obs::CObservation2DRangeScan converted;
  const std::size_t num_beams = scan.ranges_m.size();
  converted.timestamp = timestamp_of(scan.stamp);
  converted.aperture = static_cast<float>(scan.angle_increment_rad * static_cast<double>(num_beams - 1));
  converted.rightToLeft = true;
  converted.maxRange = static_cast<float>(scan.range_max_m);
  converted.resizeScan(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) {
    const float range_m = scan.ranges_m[i];
    const bool is_valid = is_return(scan, range_m);
    converted.setScanRange(i, is_valid ? range_m : converted.maxRange);
    converted.setScanRangeValidity(i, is_valid);
  }
  // MRPT's scan is symmetric about the sensor's x axis.
  const double middle_rad = scan.angle_min_rad + 0.5 * static_cast<double>(converted.aperture);
  const Eigen::Vector3d& p = T_body_lidar.position;
  converted.sensorPose = {p.x(), p.y(), p.z(), patrol::to_yaw(T_body_lidar.rotation) + middle_rad, 0.0, 0.0};
  return converted;
}

}  // namespace mrpt_stack
