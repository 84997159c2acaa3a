#include "stack/motion_executor.h"

#include <chrono>
#include <utility>

namespace patrol::stack {
namespace {

constexpr Time kDockSearchPeriod = std::chrono::seconds(1);
constexpr Time kTeleopCommandValidity = std::chrono::milliseconds(500);  // validity of a teleoperation command

DockingFeedback feedback_of(plan::DockingStatus status) {
  switch (status) {
    case plan::DockingStatus::kDocked:
    case plan::DockingStatus::kFree:
      return DockingFeedback::kDone;
    case plan::DockingStatus::kFailed:
      return DockingFeedback::kFailed;
    default:
      return DockingFeedback::kInProgress;
  }
}

}  // namespace

MotionExecutor::MotionExecutor(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                               std::uint64_t seed)
    : navigator_(settings.navigation, robot, site_in_map.keep_out_lines, seed),
      docking_(settings.docking.maneuver),
      dock_(site_in_map.dock),
      max_dock_distance_m_(settings.docking.detector.max_range_m) {
  if (dock_) dock_detector_.emplace(settings.docking.detector, dock_->profile_m);
}

std::optional<DockDetection> MotionExecutor::add(const LevelScan& scan, const ScanPose& pose) {
  navigator_.add_scan(scan, pose.T_map_body);
  return dock_detector_ ? detect_dock(scan, pose) : std::nullopt;
}

std::optional<DockDetection> MotionExecutor::detect_dock(const LevelScan& scan, const ScanPose& pose) {
  const Pose2 T_level_by_map = pose.T_map_body.inverse() * dock_->T_route_docked;
  if (docking_.status() == plan::DockingStatus::kDocking) {
    const std::optional<DockDetection> detection =
        dock_detector_->detect(scan, docking_.T_level_docked(pose.T_odom_body).value_or(T_level_by_map));
    if (detection) docking_.add(*detection, pose.T_odom_body);
    return detection;
  }
  if (scan.stamp < next_dock_search_ || T_level_by_map.position().norm() > max_dock_distance_m_) return std::nullopt;
  next_dock_search_ = scan.stamp + kDockSearchPeriod;
  return dock_detector_->detect(scan, T_level_by_map);
}

VelocityCommand MotionExecutor::step(Time now, const Task& task, const Pose2& T_map_body, const Pose2& T_odom_body,
                                     StackOutput& output) {
  const bool is_new = std::exchange(motion_, task.motion) != task.motion;
  if (is_new) {
    docking_.stop();
    docking_feedback_ = DockingFeedback::kInProgress;
  }
  if (motion_ == Motion::kNavigate) return navigate(now, task.goal, T_map_body, output);
  if (motion_ == Motion::kDock) return go_to_dock(now, T_map_body, T_odom_body, output);
  navigate(now, std::nullopt, T_map_body, output);
  if (motion_ == Motion::kTeleop) return teleop_command(now);
  if (motion_ != Motion::kUndock) return {};
  if (is_new) docking_.undock(now, T_odom_body);
  return move_at_dock(now, T_map_body, T_odom_body, output);
}

VelocityCommand MotionExecutor::navigate(Time now, const std::optional<NavigationGoal>& goal, const Pose2& T_map_body,
                                         StackOutput& output) {
  navigator_.set_goal(goal);
  plan::NavigationStep step = navigator_.step(now, T_map_body);
  if (step.replanned) output.publish(Path{now, step.path});
  if (step.is_detour) output.publish_event(now, T_map_body, EventKind::kReplan, "Path blocked: replanning.");
  if (!step.text.empty()) output.publish_event(now, T_map_body, EventKind::kNavigation, step.text);
  if (!step.recovery.empty()) output.publish_event(now, T_map_body, EventKind::kRecovery, step.recovery);
  navigation_ = step.status;
  return step.command;
}

VelocityCommand MotionExecutor::teleop_command(Time now) const {
  VelocityCommand command;
  if (!last_teleop_ || now - last_teleop_->stamp >= kTeleopCommandValidity) return command;
  command.vx_mps = last_teleop_->vx_mps;
  command.yaw_rate_radps = last_teleop_->yaw_rate_radps;
  return command;
}

/// Drives to the staging pose in front of the charging post, then docks.
VelocityCommand MotionExecutor::go_to_dock(Time now, const Pose2& T_map_body, const Pose2& T_odom_body,
                                           StackOutput& output) {
  if (docking_.status() != plan::DockingStatus::kIdle) return move_at_dock(now, T_map_body, T_odom_body, output);
  const VelocityCommand command = navigate(now, docking_.staging_goal(dock_->T_route_docked), T_map_body, output);
  if (navigation_ == plan::NavigationStatus::kArrived) docking_.dock(now);
  if (navigation_ == plan::NavigationStatus::kFailed) docking_feedback_ = DockingFeedback::kFailed;
  return command;
}

VelocityCommand MotionExecutor::move_at_dock(Time now, const Pose2& T_map_body, const Pose2& T_odom_body,
                                             StackOutput& output) {
  const plan::DockingStep step = docking_.step(now, T_odom_body);
  if (!step.text.empty()) output.publish_event(now, T_map_body, EventKind::kDocking, step.text);
  docking_feedback_ = feedback_of(step.status);
  return step.command;
}

NavigationFeedback MotionExecutor::navigation() const {
  switch (navigation_) {
    case plan::NavigationStatus::kArrived:
      return NavigationFeedback::kArrived;
    case plan::NavigationStatus::kFailed:
      return NavigationFeedback::kFailed;
    default:
      return NavigationFeedback::kDriving;
  }
}

}  // namespace patrol::stack
