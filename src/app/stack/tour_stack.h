#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/stack/robot_stack.h"
#include "app/stack/tunnel_inspection.h"

namespace patrol::app {

/// What a tour starts from, beside the survey; all in map.
struct TourStart {
  std::optional<OccupancyGrid> map;  ///< none: made on a drive by remote control
  std::vector<MarkedGoal> goals;     ///< none: marked on that drive
  LiningReferences references;       ///< scans of an earlier round
  bool has_remote = false;
  BoostedStumps neighbor_model = {};     ///< classifier of pairs of submaps, for SLAM methods that need it
};

/// The tracked robot's: maps while it is driven by remote control, then localises on that map and navigates by itself. Track
/// odometry, levelling, SLAM, Monte-Carlo localisation with UWB ranges, navigation, docking, tour, and the inspection's instruments.
class TourStack final : public RobotStack {
 public:
  /// `site` in map, whose origin is the level body pose at the start. Throws InputError when settings, robot, survey and start do not
  /// go together.
  TourStack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map, TourStart start,
            double map_period_s, std::uint64_t seed);

  void handle_fall(Time now) override;
  bool mission_is_over() const override { return tour_.is_over(); }

 private:
  void use(const SensorMessage& message) override;
  void abort(Time now, EventKind kind, const std::string& text) override { say(tour_.abort(now, kind, text)); }
  bool drives_itself() const override { return mode_ != inspect::TourMode::kRemote; }
  std::optional<OdometryEstimate> odometry() const override { return odometry_.estimate(); }
  OccupancyGrid map() override { return slam_ ? slam_->map() : *map_; }
  bool is_mapping() const override { return slam_ != nullptr; }
  VelocityCommand control(Time now, const OdometryEstimate& odometry) override;

  void handle_scan(const LaserScan& scan);
  void look_for_dock(const LevelScan& scan, const Pose2& T_odom_body, const Pose2& T_map_body);
  void localize_scan(const LevelScan& scan, const Pose2& T_odom_body);
  void handle_range(const UwbRange& range);
  void follow_ranges(const OdometryEstimate& odometry, const PoseEstimate& pose);
  void start_ranges(const OdometryEstimate& odometry, const Pose2& T_map_body, const Eigen::Matrix3d& covariance);
  void handle_ultrasonic(const UltrasonicRange& range);
  void handle_depth(const DepthImage& image);
  void handle_panorama(const PanoramicScan& scan);
  std::optional<StandingPlace> place_at(Time stamp) const;
  std::vector<UwbAnchor> anchors_above_body() const;

  VelocityCommand follow(Time now, const inspect::TourOutput& tour, const PoseEstimate& pose, const Pose2& T_odom_body);
  VelocityCommand follow_remote(Time now) const;
  VelocityCommand go_to_dock(Time now, const PoseEstimate& pose, const Pose2& T_odom_body);
  VelocityCommand move_at_dock(Time now, const Pose2& T_odom_body, const PoseEstimate& pose);
  VelocityCommand go_to(Time now, const std::optional<NavigationGoal>& goal, const PoseEstimate& pose);
  void take_over_map(Time now, const PoseEstimate& pose);
  void localize_anew(const OdometryEstimate& odometry);

  StackSettings settings_;
  RobotDescription robot_;
  Route site_in_map_;
  std::uint64_t seed_;
  localize::TrackOdometry odometry_;
  localize::ScanLeveler leveler_;
  localize::RangeFilter range_filter_;  ///< beside the others: it decides nothing
  std::unique_ptr<slam::Mapper> slam_;  ///< on the mapping drive
  std::optional<OccupancyGrid> map_;    ///< from then on
  std::optional<localize::MonteCarloLocalizer> localizer_;
  std::optional<localize::DockDetector> dock_detector_;
  plan::Docking docking_;
  inspect::Tour tour_;
  TunnelInspection inspection_;

  LocalizationTrust trust_{.trust = 1.0};
  std::optional<RemoteCommand> new_remote_, last_remote_;
  inspect::TourMode mode_ = inspect::TourMode::kStand;
  inspect::DockingFeedback docking_feedback_ = inspect::DockingFeedback::kUnderWay;
  inspect::InspectionFeedback inspection_feedback_ = inspect::InspectionFeedback::kUnderWay;
};

}  // namespace patrol::app
