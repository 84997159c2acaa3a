#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the registration of the map to the survey.
struct RegistrationSettings {
  bool use_gnss = true;  ///< use of GNSS fixes in the registration of the map
  bool use_uwb = true;   ///< use of UWB ranges in the registration of the map
  bool use_dock = true;  ///< use of detections of the charging post in the registration of the map
  /// Prior standard deviation of the position at the surveyed start, where the robot is put down by hand.
  double start_position_std_m = 0.02;
  /// Prior standard deviation of the yaw at the surveyed start, with the mounting yaw of the lidar, which turns the map
  /// against the body.
  double start_yaw_std_deg = 0.6;
  /// Prior standard deviation of the position of a given map, whose frame has been surveyed.
  double given_map_position_std_m = 0.02;
  /// Prior standard deviation of the yaw of a given map, whose frame has been surveyed.
  double given_map_yaw_std_deg = 0.05;
  double fix_correlation_time_s = 20.0;  ///< correlation time of the errors of RTK fixes (core/sensors/gnss.h)
  /// Correlation time of the errors of RTK float solutions (core/sensors/gnss.h).
  double float_correlation_time_s = 60.0;
  double dock_std_m = 0.02;  ///< standard deviation of the position of the charging post: survey and outline
  /// Standard deviation of the yaw of the charging post. It contains the bend of the map beyond the post. A yaw that
  /// holds at the post moves the other end of a bent map of 150 m.
  double dock_yaw_std_deg = 1.0;
  /// Standard deviation of a UWB range in line of sight, without the constant error of its anchor.
  double range_std_m = 0.12;
  double range_correlation_time_s = 2.0;  ///< correlation time of the errors of UWB ranges: reflections
  double anchor_delay_std_m = 0.1;        ///< standard deviation of the constant error of the ranges to an anchor
  double range_min_distance_m = 2.0;      ///< minimum distance between two UWB ranges to one anchor
  /// Standard deviation of the map's own deformation at a position. It is added in quadrature to the standard deviation
  /// of each measurement and of the published pose.
  double map_std_m = 0.02;
  /// Correlation time of the map's deformation. The sum of the errors of a GNSS position and of the map is one process
  /// with the longer of their correlation times.
  double map_correlation_time_s = 100.0;
  /// Standard deviation of the body's yaw by the map's own deformation, with the remaining error of the lidar's
  /// mounting yaw.
  double map_yaw_std_deg = 0.15;
  /// Minimum distance between two GNSS fixes of one status, or between two detections of the charging post.
  double min_distance_m = 0.5;
  double max_interval_s = 10.0;      ///< maximum time between two measurements of one source while the robot stands
  int max_measurements = 600;        ///< maximum number of stored measurements; above it every second one is dropped
  double outlier_scale_sigma = 4.0;  ///< scale of the Cauchy loss of a measurement, in standard deviations
  double period_s = 1.0;             ///< period of the registration of the map
  /// Minimum displacement of any point of the survey for which the mission's stations and the keep-out lines follow the
  /// registration.
  double min_site_shift_m = 0.03;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("use_gnss", self.use_gnss);
    visit("use_uwb", self.use_uwb);
    visit("use_dock", self.use_dock);
    visit("start_position_std_m", self.start_position_std_m, between(1e-4, 1e6));
    visit("start_yaw_std_deg", self.start_yaw_std_deg, between(1e-4, 1e6));
    visit("given_map_position_std_m", self.given_map_position_std_m, between(1e-4, 1e6));
    visit("given_map_yaw_std_deg", self.given_map_yaw_std_deg, between(1e-4, 1e6));
    visit("fix_correlation_time_s", self.fix_correlation_time_s, between(0.0, 1e4));
    visit("float_correlation_time_s", self.float_correlation_time_s, between(0.0, 1e4));
    visit("dock_std_m", self.dock_std_m, between(1e-4, 10.0));
    visit("dock_yaw_std_deg", self.dock_yaw_std_deg, between(1e-3, 90.0));
    visit("range_std_m", self.range_std_m, between(1e-4, 10.0));
    visit("range_correlation_time_s", self.range_correlation_time_s, between(0.0, 1e4));
    visit("anchor_delay_std_m", self.anchor_delay_std_m, between(1e-6, 10.0));
    visit("range_min_distance_m", self.range_min_distance_m, between(0.0, 100.0));
    visit("map_std_m", self.map_std_m, between(0.0, 10.0));
    visit("map_correlation_time_s", self.map_correlation_time_s, between(0.0, 1e4));
    visit("map_yaw_std_deg", self.map_yaw_std_deg, between(0.0, 10.0));
    visit("min_distance_m", self.min_distance_m, between(0.0, 100.0));
    visit("max_interval_s", self.max_interval_s, between(0.1, 1e4));
    visit("max_measurements", self.max_measurements, between(10, 100000));
    visit("outlier_scale_sigma", self.outlier_scale_sigma, between(0.1, 1e6));
    visit("period_s", self.period_s, between(0.1, 100.0));
    visit("min_site_shift_m", self.min_site_shift_m, between(0.001, 10.0));
  }
};

}  // namespace patrol::localize
