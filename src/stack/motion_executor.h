#pragma once

#include <cstdint>
#include <optional>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "localize/dock_detector.h"
#include "plan/control/docking.h"
#include "plan/navigation/navigator.h"
#include "stack/instruments/station_pose.h"
#include "stack/localization/pose_pipeline.h"
#include "stack/mission/task.h"
#include "stack/output/stack_output.h"
#include "stack/settings/stack_settings.h"

namespace patrol::stack {

/// Executes the motion of a task: navigation to a goal, docking, undocking, or teleoperation.
class MotionExecutor {
 public:
  /// Throws InputError when settings and robot are inconsistent.
  MotionExecutor(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                 std::uint64_t seed);

  void set_map(const OccupancyGrid& map) { navigator_.set_map(map); }
  /// Replaces the survey in map: keep-out lines and charging post.
  void set_site(const Route& site_in_map) {
    navigator_.set_keep_out_lines(site_in_map.keep_out_lines);
    dock_ = site_in_map.dock;
  }
  /// Adds obstacles. Returns a detection of the charging post, which is searched in every scan while the robot docks,
  /// and else once a second near the post.
  std::optional<DockDetection> add(const LevelScan& scan, const ScanPose& pose);
  void add(const UltrasonicRange& range, const StationPose& station_pose) {
    navigator_.add_range(range, tilt(station_pose), station_pose.T_map_body);
  }
  void add(const DepthImage& image, const StationPose& station_pose) {
    navigator_.add_depth(image, tilt(station_pose), station_pose.T_map_body);
  }
  void add(const TeleopCommand& command) { last_teleop_ = command; }

  /// Returns the velocity command for a control period; publishes paths and events.
  VelocityCommand step(Time now, const Task& task, const Pose2& T_map_body, const Pose2& T_odom_body,
                       StackOutput& output);

  NavigationFeedback navigation() const;
  DockingFeedback docking() const { return docking_feedback_; }
  /// Returns whether the robot is teleoperated.
  bool is_teleoperated() const { return motion_ == Motion::kTeleop; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(navigator_, docking_, dock_, next_dock_search_, last_teleop_, motion_, navigation_, docking_feedback_);
  }

 private:
  /// Body pose in the navigator's `level`, whose origin is the body's; that of a station pose is on the ground.
  static Pose3 tilt(const StationPose& station_pose) {
    return {Eigen::Vector3d::Zero(), station_pose.T_level_body.rotation};
  }
  VelocityCommand navigate(Time now, const std::optional<NavigationGoal>& goal, const Pose2& T_map_body,
                           StackOutput& output);
  VelocityCommand teleop_command(Time now) const;
  VelocityCommand go_to_dock(Time now, const Pose2& T_map_body, const Pose2& T_odom_body, StackOutput& output);
  VelocityCommand move_at_dock(Time now, const Pose2& T_map_body, const Pose2& T_odom_body, StackOutput& output);
  std::optional<DockDetection> detect_dock(const LevelScan& scan, const ScanPose& pose);

  plan::Navigator navigator_;
  plan::Docking docking_;
  std::optional<Dock> dock_;
  std::optional<localize::DockDetector> dock_detector_;
  double max_dock_distance_m_;
  Time next_dock_search_{};
  std::optional<TeleopCommand> last_teleop_;
  Motion motion_ = Motion::kStand;
  plan::NavigationStatus navigation_ = plan::NavigationStatus::kIdle;
  DockingFeedback docking_feedback_ = DockingFeedback::kInProgress;
};

}  // namespace patrol::stack
