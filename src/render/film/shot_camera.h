#pragma once

#include "render/camera.h"
#include "render/film/shot_plan.h"

namespace patrol::render {

/// The camera of one shot. It stands off in a direction of the world that it keeps, but for a slow swing, and moves along with
/// the robot: of several directions the first from which nothing stands before the robot, neither now nor at the moment that the
/// shot is about; where something does, it comes nearer. From above, it has both the robot and the place where it believes to be
/// in the picture.
class ShotCamera {
 public:
  /// `T_world_body` when the shot begins; `free_distance` as for CameraRig.
  ShotCamera(const Shot& shot, FreeDistance free_distance, const Pose3& T_world_body);

  /// `elapsed_s` since the last frame, as it will be watched.
  View follow(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s);

 private:
  View from_above(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s);
  Eigen::Vector3d focus_of(const Pose3& T_world_body) const;
  Eigen::Vector3d offset_m(const Eigen::Vector3d& p_world_body) const;
  double choose_bearing(const Pose3& T_world_body) const;

  Shot shot_;
  FreeDistance free_distance_;
  Eigen::Vector3d focus_m_;  ///< smoothed
  double bearing_rad_;       ///< from the focus to the eye, in world
  double reach_ = 1.0;       ///< smoothed; 1 where nothing is in the way
  double height_m_ = 10.0;   ///< smoothed; of a look from above
};

}  // namespace patrol::render
