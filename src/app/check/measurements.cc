#include "app/check/measurements.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/angles.h"

namespace patrol::app {

MotorMargins motor_margins(const DriveRecord& record) {
  MotorMargins margins;
  for (const DriveSample& sample : record.samples) {
    margins.max_torque_ratio = std::max(margins.max_torque_ratio, sample.max_torque_ratio);
    margins.mean_torque_ratio += sample.mean_torque_ratio / static_cast<double>(record.samples.size());
    margins.max_speed_ratio = std::max(margins.max_speed_ratio, sample.max_speed_ratio);
  }
  return margins;
}

double max_tilt_deg(const DriveRecord& record) {
  double tilt_rad = 0.0;
  for (const DriveSample& sample : record.samples) tilt_rad = std::max(tilt_rad, sample.tilt_rad);
  return to_deg(tilt_rad);
}

double slip_ratio(const DriveRecord& record) {
  constexpr double kMinTravel_m = 0.05;
  const DriveSample& end = record.samples.back();
  const double travel_m = 0.5 * (end.left_travel_m + end.right_travel_m);
  return std::abs(travel_m) < kMinTravel_m ? 0.0 : 1.0 - end.ground_travel_m / travel_m;
}

double yaw_ratio(const DriveRecord& record) {
  const DriveSample& end = record.samples.back();
  return end.yaw_rad / end.commanded_yaw_rad;
}

double max_center_distance_m(const DriveRecord& record) {
  double distance_m = 0.0;
  for (const DriveSample& sample : record.samples)
    distance_m = std::max(distance_m, sample.T_start_center.position().norm());
  return distance_m;
}

Circle driven_circle(const DriveRecord& record, double from, double to) {
  const double end_rad = record.samples.back().commanded_yaw_rad;
  std::vector<Eigen::Vector2d> points_m;
  for (const DriveSample& sample : record.samples) {
    const double fraction = sample.commanded_yaw_rad / end_rad;
    if (fraction >= from && fraction <= to) points_m.push_back(sample.T_start_center.position());
  }
  return fit_circle(points_m);
}

double effective_gauge_ratio(const DriveRecord& record, double gauge_m) {
  const DriveSample& end = record.samples.back();
  return (end.right_travel_m - end.left_travel_m) / (gauge_m * end.yaw_rad);
}

Stop measure_stop(const DriveRecord& record, double rest_speed_mps) {
  const std::vector<DriveSample>& samples = record.samples;
  std::size_t begin = samples.size() - 1;
  while (begin > 0 && samples[begin].commanded_speed_mps == 0.0) --begin;
  std::size_t end = samples.size();
  while (end > begin + 1 && std::abs(samples[end - 1].speed_mps) < rest_speed_mps) --end;
  const DriveSample& at_rest = samples[std::min(end, samples.size() - 1)];
  return {.speed_mps = samples[begin].speed_mps,
          .distance_m = at_rest.ground_travel_m - samples[begin].ground_travel_m,
          .duration_s = at_rest.time_s - samples[begin].time_s,
          .is_at_rest = end < samples.size()};
}

}  // namespace patrol::app
