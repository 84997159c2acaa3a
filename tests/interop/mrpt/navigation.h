#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>

#include "core/messages.h"
#include "navigation_settings.h"
#include "odometry.h"
#include "positioning.h"
#include "robot_interface.h"

namespace mrpt_stack {

/// Drives to one goal after the other: a path on the grid, followed by the reactive navigator.
class Navigation {
 public:
  /// `cache`: folder of the trajectories' collision grids, of one robot.
  Navigation(const std::vector<Eigen::Vector2d>& footprint_m, std::vector<Pose2> goals, NavigationSettings settings,
             const std::filesystem::path& cache);

  /// Replaces the obstacles of the reactive navigator, in body.
  void set_obstacles(const mrpt::maps::CSimplePointsMap& obstacles) { robot_.obstacles = obstacles; }

  /// Returns the velocity command of this instant.
  patrol::VelocityCommand step(Time now, const Positioning& positioning, const Odometry& odometry);

  std::size_t num_reached() const { return next_goal_; }
  bool is_over() const { return next_goal_ >= goals_.size(); }
  const std::vector<Pose2>& path() const { return path_; }

 private:
  void plan(const mrpt::maps::COccupancyGridMap2D& grid, const Pose2& T_map_body);
  Pose2 carrot() const;
  /// Returns the least distance of an obstacle from the line from the body to a point in body, m.
  double clearance_m(const Eigen::Vector2d& p_body) const;
  void request(const Pose2& target);
  bool is_backing_up(const Odometry& odometry);
  /// Begins to back up if the navigator has found no way for some time.
  void note_stop(const Odometry& odometry);
  bool is_free_behind() const;

  NavigationSettings settings_;
  RobotInterface robot_;
  std::unique_ptr<mrpt::nav::CReactiveNavigationSystem> navigator_;
  std::vector<Eigen::Vector2d> footprint_m_;
  std::vector<Pose2> goals_;
  std::size_t next_goal_ = 0;
  std::vector<Pose2> path_;
  Time next_plan_{};
  bool has_left_ = false;  ///< the charging post
  bool is_turning_ = false;
  std::optional<Time> stopped_since_;      ///< the navigator finds no way
  std::optional<double> backing_up_to_m_;  ///< distance of odometry at which the way backward ends
};

}  // namespace mrpt_stack
