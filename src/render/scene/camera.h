#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "core/frames.h"

namespace patrol::render {

/// Viewpoint of the camera that follows the robot.
enum class CameraKind {
  kChase,    ///< view from behind and above the robot
  kTop,      ///< vertically down, north up; a roof is cut away
  kOnboard,  ///< from the robot's head, looking forward
};

/// Parses "chase", "top" or "onboard". Throws InputError for any other text.
CameraKind parse_camera_kind(const std::string& name);

/// Pose, target and projection of a camera.
struct View {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();       ///< camera position in world, m
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< viewing direction, unit vector
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();       ///< unit vector orthogonal to `forward`
  /// point of interest in world, m; light and shadows are centered there
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();
  double field_of_view_rad = 0.9;  ///< vertical opening angle
  double near_m = 0.05;
  double far_m = 200.0;
};

/// View from `eye` to `focus` with the default field of view. The horizon is level; north is up in a vertical view.
View look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& focus);

/// View of the center of a box in world, m, from the direction `to_eye`, of any length, at a distance that shows the
/// whole box in a picture that is not higher than wide.
View look_at(const Eigen::AlignedBox3d& box_m, const Eigen::Vector3d& to_eye);

/// Converts a view to MuJoCo's camera.
mjvGLCamera gl_camera(const View& view);

/// Pixel position of a world point: x right and y down from the upper left corner of the picture.
struct Projected {
  Eigen::Vector2d pixel;
  double distance_m;  ///< distance along the viewing axis
};

/// Pinhole projection, equal to MuJoCo's perspective camera.
class Projector {
 public:
  Projector(const View& view, int width, int height);

  /// Transforms a point from world to the camera frame: right, up, ahead.
  Eigen::Vector3d to_camera(const Eigen::Vector3d& point_m) const { return R_camera_world_ * (point_m - eye_m_); }
  /// Projects a point of the camera frame that lies ahead of the camera.
  Projected project_camera(const Eigen::Vector3d& in_camera_m) const {
    const double scale = focal_px_ / in_camera_m.z();
    return {center_px_ + scale * Eigen::Vector2d(in_camera_m.x(), -in_camera_m.y()), in_camera_m.z()};
  }
  /// Projects a world point, none if it lies behind the near plane.
  std::optional<Projected> project(const Eigen::Vector3d& point_m) const;
  /// Distance along the viewing axis of a depth buffer value (0 near, 1 far).
  double distance_m(float depth) const {
    return near_m_ * far_m_ / (far_m_ - static_cast<double>(depth) * (far_m_ - near_m_));
  }

  double near_m() const { return near_m_; }
  double focal_px() const { return focal_px_; }

 private:
  Eigen::Matrix3d R_camera_world_;
  Eigen::Vector3d eye_m_;
  Eigen::Vector2d center_px_;
  double focal_px_;
  double near_m_;
  double far_m_;
};

/// Free distance from a point along a unit vector, at most `max_m`.
using FreeDistance =
    std::function<double(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double max_m)>;

/// View vertically down on a point, north up, from `height_m` above it. A roof is cut away.
View look_down(const Eigen::Vector3d& focus, double height_m, const FreeDistance& free_distance);

/// Camera that follows the robot. Low-pass filters in film time remove the oscillation of the gait. The chase camera
/// moves closer when an obstacle is between it and the robot, and looks higher under a roof.
class CameraRig {
 public:
  /// `head_m` is the position of the onboard camera in the level body frame.
  explicit CameraRig(CameraKind kind, FreeDistance free_distance = {}, Eigen::Vector3d head_m = {0.33, 0.0, 0.12})
      : kind_(kind), free_distance_(std::move(free_distance)), head_m_(std::move(head_m)) {}

  /// Returns the view of the next frame, `elapsed_s` of film time after the previous one.
  View follow(const Pose3& T_world_body, double elapsed_s);

 private:
  View chase(double elapsed_s);
  View on_board(const Pose3& T_world_body) const;

  CameraKind kind_;
  FreeDistance free_distance_;
  Eigen::Vector3d head_m_;
  std::optional<Eigen::Vector3d> focus_m_;  ///< low-pass filtered
  double heading_rad_ = 0.0;                ///< low-pass filtered
  double distance_fraction_ = 1.0;  ///< fraction of the full camera distance, low-pass filtered; 1 without obstacles
  double roof_weight_ = 0.0;        ///< low-pass filtered; 1 under a roof
};

}  // namespace patrol::render
