#pragma once

#include "render/film/shot_plan.h"
#include "render/scene/camera.h"

namespace patrol::render {

/// Camera of one shot. It keeps its bearing in world, except for a slow rotation, and moves with the robot. The bearing
/// is the first of several with the largest free distance, both now and at the shot's highlight. The camera moves
/// closer when an obstacle blocks the view. In an overhead shot the picture contains the robot and its estimated
/// position.
class ShotCamera {
 public:
  /// `T_world_body` is the pose at the start of the shot; `free_distance` as in CameraRig.
  ShotCamera(Shot shot, FreeDistance free_distance, const Pose3& T_world_body);

  /// Returns the view of the next frame, `elapsed_s` of film time after the previous one.
  View follow(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s);

 private:
  View from_above(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s);
  Eigen::Vector3d focus_of(const Pose3& T_world_body) const;
  Eigen::Vector3d offset_m(const Eigen::Vector3d& p_world_body) const;
  double choose_bearing(const Pose3& T_world_body) const;

  Shot shot_;
  FreeDistance free_distance_;
  Eigen::Vector3d focus_m_;         ///< low-pass filtered
  double bearing_rad_;              ///< from the focus to the camera, in world
  double distance_fraction_ = 1.0;  ///< fraction of the full camera distance, low-pass filtered; 1 without obstacles
  double height_m_ = 10.0;          ///< height of an overhead shot, low-pass filtered
};

}  // namespace patrol::render
