#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "core/frames.h"

namespace patrol::render {

enum class CameraKind {
  kChase,    ///< behind and above the robot
  kTop,      ///< straight down, north up; a roof is cut away
  kOnboard,  ///< from the robot's head, looking ahead
};

/// "chase", "top" or "onboard"; throws InputError for anything else.
CameraKind camera_kind(const std::string& name);

/// Where the eye is and what it takes in.
struct View {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();       ///< m, in world
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();       ///< unit, across `forward`
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();     ///< what it is about: light and shadows go there
  double field_of_view_rad = 0.9;                      ///< vertical
  double near_m = 0.05;
  double far_m = 200.0;
};

View look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& focus);

mjvGLCamera gl_camera(const View& view);

/// A point of the world as a pixel: x right and y down from the picture's upper left corner.
struct Projected {
  Eigen::Vector2d pixel;
  double distance_m;  ///< along the view's axis
};

/// The pinhole that MuJoCo's perspective cameras are.
class Projector {
 public:
  Projector(const View& view, int width, int height);

  /// In the camera: right, up, ahead.
  Eigen::Vector3d to_camera(const Eigen::Vector3d& point_m) const {
    return R_camera_world_ * (point_m - eye_m_);
  }
  /// Of a point ahead of the camera.
  Projected project_camera(const Eigen::Vector3d& in_camera_m) const {
    const double scale = focal_px_ / in_camera_m.z();
    return {center_px_ + scale * Eigen::Vector2d(in_camera_m.x(), -in_camera_m.y()), in_camera_m.z()};
  }
  /// None behind the near plane.
  std::optional<Projected> project(const Eigen::Vector3d& point_m) const;
  /// Distance along the axis of what the depth buffer (0 near, 1 far) holds.
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

/// How far one can go from a point along a unit vector, at most `max_m`.
using FreeDistance =
    std::function<double(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double max_m)>;

/// Straight down on a place, north up, from `height_m` above it; a roof is cut away.
View look_down(const Eigen::Vector3d& focus, double height_m, const FreeDistance& free_distance);

/// Follows the robot. What moves with each step of the trot is smoothed away, in the time of the one who
/// watches. The chasing camera comes nearer where something would stand between it and the robot, and looks
/// up where there is a roof: that is what a tunnel is known by.
class CameraRig {
 public:
  /// `head_m` is where the onboard camera is, in the level body.
  explicit CameraRig(CameraKind kind, FreeDistance free_distance = {},
                     const Eigen::Vector3d& head_m = {0.33, 0.0, 0.12})
      : kind_(kind), free_distance_(std::move(free_distance)), head_m_(head_m) {}

  /// `elapsed_s` since the last frame, as it will be watched.
  View follow(const Pose3& T_world_body, double elapsed_s);

 private:
  View chase(double elapsed_s);
  View on_board(const Pose3& T_world_body) const;

  CameraKind kind_;
  FreeDistance free_distance_;
  Eigen::Vector3d head_m_;
  std::optional<Eigen::Vector3d> focus_m_;  ///< smoothed
  double heading_rad_ = 0.0;                ///< smoothed
  double reach_ = 1.0;                      ///< smoothed; 1 where nothing is in the way
  double roofed_ = 0.0;                     ///< smoothed; 1 under a roof
};

}  // namespace patrol::render
