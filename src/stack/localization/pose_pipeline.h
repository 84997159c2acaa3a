#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "core/site/site_frame.h"
#include "core/site/site_registration.h"
#include "localize/calibration/online_calibrator.h"
#include "localize/line_of_sight_monitor.h"
#include "localize/map_correction.h"
#include "localize/map_pose_tracker.h"
#include "localize/scan_leveler.h"
#include "stack/instruments/station_pose.h"
#include "stack/localization/delayed_localizer.h"
#include "stack/localization/make_localizer.h"
#include "stack/localization/odometry_source.h"
#include "stack/localization/range_pose_tracker.h"
#include "stack/localization/scan_counts.h"
#include "stack/localization/site_registrar.h"
#include "stack/sensors/clock_monitor.h"

namespace patrol::stack {

/// Pose of the body in `map` and in `odom` at a scan.
struct ScanPose {
  Pose2 T_odom_body;
  Pose2 T_map_body;
};

/// Odometry source, scan leveling and localizer in series: converts sensor messages to the pose in `map` and the map.
class PosePipeline {
 public:
  /// Returns the covariance of a surveyed pose at which the robot has been placed.
  static Eigen::Matrix3d surveyed_covariance();

  /// `has_thread`: whether SLAM has a thread of its own, with the same results. Throws InputError when settings, robot
  /// and map are inconsistent.
  PosePipeline(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
               const LocalizerStart& start, std::uint64_t seed, const SiteFrame& site = {}, bool has_thread = false);

  /// Processes a sensor message other than a scan; `level` and `localize` process scans.
  void add(const SensorMessage& message, StackOutput& output);
  /// Returns the newest odometry. Call at every step: the first estimate starts the settling time of odometry.
  std::optional<OdometryEstimate> update_odometry();
  /// Returns the level scan; none before odometry has settled, because the first scan defines the map's origin.
  std::optional<LevelScan> level(const LaserScan& scan, StackOutput& output);
  /// Gives the localizer a scan that arrived at `received`. Returns the pose at the scan as known by then: by SLAM it
  /// does not contain the scan itself.
  ScanPose localize(const LevelScan& scan, Time received, StackOutput& output);
  /// Corrects the pose by the scans whose computation ends by `now`, and publishes their estimates.
  void correct(Time now, StackOutput& output);
  /// Adds a detection of the surveyed charging post to the registration of the map.
  void add(const DockDetection& detection);
  /// Publishes the pose from odometry and UWB ranges alone, if robot and site have UWB.
  void publish_range_pose(const OdometryEstimate& odometry, const PoseEstimate& pose, StackOutput& output);

  /// Returns the registration of the map to the site if it is due and has changed; none before the first scan.
  std::optional<SiteRegistration> register_to_site(Time now);
  /// Moves the survey in map: the localizer's anchors follow the registration.
  void set_site(const Route& site_in_map);
  /// Publishes the estimates of the calibration at their period, if it is enabled.
  void publish_calibration(Time now, StackOutput& output);
  /// Returns the estimated clock of the lidar; none if the calibration is disabled.
  std::optional<LidarClock> lidar_clock(Time now) const;

  PoseEstimate pose_at(Time stamp, const Pose2& T_odom_body) const { return tracker_.at(stamp, T_odom_body); }
  /// Returns the body pose at an instant; none outside the time span of odometry.
  std::optional<StationPose> station_pose_at(Time stamp) const;
  OccupancyGrid map() { return localizer_.wait().map(); }
  bool is_mapping() const { return localizer_.is_mapping(); }
  bool is_lost() const { return localizer_.is_lost(); }

  /// Returns whether the first scan of the map is still to come. It must be taken at rest, at the map's origin. After
  /// the settling time of odometry the answer is true for 2 s at most: scans may be missing.
  bool awaits_first_scan(Time now) const;
  /// Returns why there is no map, as a sentence; none unless the robot maps and no scan was used.
  std::optional<std::string> mapping_failure() const;
  /// Ends the mapping with its final optimization, which the pose and the registration to the site follow. `odometry`:
  /// present odometry. Returns the motion of the map; none where the map is given or complete.
  std::optional<localize::MapCorrection> finish_map(const OdometryEstimate& odometry, StackOutput& output);
  void start_global_localization() { localizer_.wait().start_global_localization(); }
  /// Starts at the surveyed start, the origin of map, before the robot has moved.
  void start_at_survey() { localizer_.wait().set_initial_pose(Pose2{}, surveyed_covariance()); }
  /// Restarts at a surveyed pose; every component discards its previous pose.
  void restart_at(const Pose2& T_map_body, const OdometryEstimate& odometry);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(odometry_, localizer_, tracker_, registrar_, num_scans_, mapped_, T_map_mapped_, T_odom_scan_, scan_counts_,
            anchors_in_map_, line_of_sight_, next_calibration_, first_odometry_);
    archive.part(range_pose_);
    archive.part(calibrator_);
  }

 private:
  bool has_settled(Time stamp) const { return first_odometry_ && stamp >= *first_odometry_ + settle_; }
  double height_m() const;
  void add_range(const UwbRange& range);
  bool is_in_line_of_sight(const UwbRange& range, const Pose3& T_odom_body);
  void add_fix(const GnssFix& fix);
  void add_to_registration(const UwbRange& range, const Pose3& T_odom_body);
  std::optional<PoseFromScan> pose_from_scan(Time stamp) const;
  void add_to_calibration(const Imu& imu);
  void add_to_calibration(const UwbRange& range, const Pose3& T_odom_body);
  std::optional<LevelScan> level_corrected(const LaserScan& scan, StackOutput& output);
  std::optional<LevelScan> level_as_stamped(const LaserScan& scan, StackOutput& output) const;

  Time settle_;
  std::unique_ptr<OdometrySource> odometry_;
  localize::ScanLeveler leveler_;
  DelayedLocalizer localizer_;
  std::optional<RangePoseTracker> range_pose_;  ///< present for a robot with a UWB antenna
  localize::MapPoseTracker tracker_;
  SiteRegistrar registrar_;
  Pose2 T_start_site_;
  std::optional<Pose3> T_body_gnss_;    ///< present for a robot with a GNSS antenna
  double max_mapping_tilt_rad_;         ///< tilt above which the SLAM method does not use scans
  ScanCounts scan_counts_;              ///< counts of all received scans
  std::size_t num_scans_ = 0;           ///< scans that have corrected the pose
  std::vector<Time> mapped_;            ///< stamps of the scans while the robot maps
  std::vector<Pose2> T_map_mapped_;     ///< [scan] body pose at each of them, as estimated then
  Pose2 T_odom_scan_;                   ///< body at the newest of them
  Pose3 T_body_lidar_;                  ///< nominal
  std::optional<Pose2> T_site_docked_;  ///< surveyed pose of the docked body; none without a charging post
  std::vector<UwbAnchor> anchors_in_site_;
  std::vector<UwbAnchor> anchors_in_map_;
  UwbCalibration uwb_calibration_;
  localize::LineOfSightMonitor line_of_sight_;
  Pose3 T_body_uwb_;                                      ///< nominal, for a robot with a UWB antenna
  std::optional<localize::OnlineCalibrator> calibrator_;  ///< present if the calibration is enabled
  Time calibration_period_;
  Time next_calibration_{};
  std::optional<Time> first_odometry_;
};

}  // namespace patrol::stack
