#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "plan/control/differential_pose_controller.h"
#include "plan/navigation/navigation_step.h"
#include "plan/navigation/navigator_settings.h"
#include "plan/navigation/progress_monitor.h"
#include "plan/navigation/recovery_sequence.h"
#include "plan/navigation/route_follower.h"
#include "plan/navigation/route_search.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Navigates the robot to a goal pose: layered costmap, global planner, local planner, and a separate controller for
/// the last meter. When blocked it waits, runs recovery behaviors and replans; reports failure when no route exists.
class Navigator {
 public:
  /// `seed`: random seed of the stochastic global planners. Throws InputError if a setting breaks its rule or the robot
  /// has no footprint.
  Navigator(const NavigatorSettings& settings, const RobotDescription& robot,
            std::vector<Polyline> keep_out_lines_in_map, std::uint64_t seed = 0);

  void set_map(const OccupancyGrid& map);
  /// Replaces the keep-out lines.
  void set_keep_out_lines(std::vector<Polyline> lines_in_map);
  void add_scan(const LevelScan& scan, const Pose2& T_map_body) { costmap_.add_scan(scan, T_map_body); }
  /// Adds a depth image; `T_level_body` is the body's tilt, without its height above the ground. Throws InputError if
  /// the robot has no such camera.
  void add_depth(const DepthImage& image, const Pose3& T_level_body, const Pose2& T_map_body);
  /// Adds an ultrasonic range; `T_level_body` as for a depth image. Throws InputError if the robot has no such
  /// transducer.
  void add_range(const UltrasonicRange& ping, const Pose3& T_level_body, const Pose2& T_map_body);
  /// Sets the goal; an unchanged goal has no effect. None stops the robot.
  void set_goal(const std::optional<NavigationGoal>& goal);

  /// Command and status of one control period.
  NavigationStep step(Time now, const Pose2& T_map_body);

  const Costmap& costmap() const { return costmap_; }
  const PlannedPath& path() const { return follower_->path(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(costmap_, search_, follower_, approach_, recoveries_, progress_, state_, goal_, last_, blocked_since_,
            no_path_since_, failure_, text_, recovery_text_);
  }

 private:
  /// kFollowing: driving along a path, or waiting for one. kApproaching: the differential approach is active.
  enum class State { kIdle, kFollowing, kApproaching, kRecovering, kArrived, kFailed };

  bool is_at_goal(const Pose2& T_map_body) const;
  bool must_abort(Time now) const;
  void check_end(Time now, const Pose2& T_map_body);
  NavigationStatus act(Time now, const Pose2& T_map_body, NavigationStep& step);

  // Actions in kFollowing and kApproaching.
  NavigationStatus navigate(Time now, const Pose2& T_map_body, NavigationStep& step);
  void search_if_needed(Time now, const Pose2& T_map_body);
  void take_route(Time now, const Pose2& T_map_body, NavigationStep& step);
  NavigationStatus drive(Time now, const Pose2& T_map_body, VelocityCommand& command);
  void choose_approach(double goal_distance_m);
  NavigationStatus approach(Time now, const Pose2& T_map_body, VelocityCommand& command);
  NavigationStatus wait_for_route(Time now);
  NavigationStatus wait_blocked(Time now, const Pose2& T_map_body, VelocityCommand& command);
  void update_progress(const Pose2& T_map_body);

  // Actions in kRecovering.
  NavigationStatus begin_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command);
  NavigationStatus continue_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command);

  void report(NavigationFailure failure);

  NavigatorSettings settings_;
  RobotDescription robot_;
  Costmap costmap_;
  RouteSearch search_;
  std::unique_ptr<RouteFollower> follower_;
  DifferentialPoseController approach_;
  RecoverySequence recoveries_;
  ProgressMonitor progress_;

  State state_ = State::kIdle;
  std::optional<NavigationGoal> goal_;
  VelocityCommand last_;  ///< command of the previous control period
  std::optional<Time> blocked_since_;
  std::optional<Time> no_path_since_;
  NavigationFailure failure_ = NavigationFailure::kNone;
  std::string text_, recovery_text_;  ///< sentences for the next step
};

}  // namespace patrol::plan
