#include "render/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace patrol::render {

namespace {

/// Height of the roof above the robot's body, m; none without a roof.
std::optional<double> roof_height_m(const Eigen::Vector3d& p_world_body, const FreeDistance& free_distance) {
  constexpr double kMastHeight_m = 0.6, kHighest_m = 12.0;
  if (!free_distance) return std::nullopt;
  const double free_m =
      free_distance(p_world_body + kMastHeight_m * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), kHighest_m);
  if (free_m >= kHighest_m) return std::nullopt;
  return kMastHeight_m + free_m;
}

}  // namespace

CameraKind parse_camera_kind(const std::string& name) {
  if (name == "chase") return CameraKind::kChase;
  if (name == "top") return CameraKind::kTop;
  if (name == "onboard") return CameraKind::kOnboard;
  throw InputError(name + ": must be one of chase, top, onboard");
}

View look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& focus) {
  View view{.eye = eye, .forward = (focus - eye).normalized(), .focus = focus};
  // North is up in a vertical view.
  const bool is_vertical = std::abs(view.forward.z()) > 0.999;
  const Eigen::Vector3d hint = is_vertical ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  view.up = (hint - hint.dot(view.forward) * view.forward).normalized();
  return view;
}

View look_at(const Eigen::AlignedBox3d& box_m, const Eigen::Vector3d& to_eye) {
  constexpr double kMargin = 1.1;
  const double radius_m = 0.5 * box_m.diagonal().norm();
  const double distance_m = kMargin * radius_m / std::sin(0.5 * View{}.field_of_view_rad);
  return look_at(box_m.center() + distance_m * to_eye.normalized(), box_m.center());
}

View look_down(const Eigen::Vector3d& focus, double height_m, const FreeDistance& free_distance) {
  constexpr double kCut = 0.6;  // fraction of the roof's height at which it is cut
  View view = look_at(focus + height_m * Eigen::Vector3d::UnitZ(), focus);
  if (const auto roof_m = roof_height_m(focus, free_distance)) view.near_m = height_m - kCut * *roof_m;
  return view;
}

mjvGLCamera gl_camera(const View& view) {
  const auto top = static_cast<float>(view.near_m * std::tan(0.5 * view.field_of_view_rad));
  mjvGLCamera camera{};
  for (int axis = 0; axis < 3; ++axis) {
    camera.pos[axis] = static_cast<float>(view.eye[axis]);
    camera.forward[axis] = static_cast<float>(view.forward[axis]);
    camera.up[axis] = static_cast<float>(view.up[axis]);
  }
  camera.frustum_bottom = -top;
  camera.frustum_top = top;
  camera.frustum_near = static_cast<float>(view.near_m);
  camera.frustum_far = static_cast<float>(view.far_m);
  return camera;
}

Projector::Projector(const View& view, int width, int height)
    : eye_m_(view.eye),
      center_px_(0.5 * width, 0.5 * height),
      focal_px_(0.5 * height / std::tan(0.5 * view.field_of_view_rad)),
      near_m_(view.near_m),
      far_m_(view.far_m) {
  R_camera_world_ << view.forward.cross(view.up).transpose(), view.up.transpose(), view.forward.transpose();
}

std::optional<Projected> Projector::project(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d in_camera = to_camera(point_m);
  if (in_camera.z() < near_m_) return std::nullopt;
  return project_camera(in_camera);
}

View CameraRig::follow(const Pose3& T_world_body, double elapsed_s) {
  constexpr double kFollow_s = 0.25, kTurn_s = 0.6;  // time constants
  constexpr double kTopHeight_m = 14.0;
  const double heading = to_yaw(T_world_body.rotation);
  if (!focus_m_) {
    focus_m_ = T_world_body.position;
    heading_rad_ = heading;
  }
  *focus_m_ += (1.0 - std::exp(-elapsed_s / kFollow_s)) * (T_world_body.position - *focus_m_);
  heading_rad_ += (1.0 - std::exp(-elapsed_s / kTurn_s)) * wrap_angle(heading - heading_rad_);

  switch (kind_) {
    case CameraKind::kTop:
      return look_down(*focus_m_, kTopHeight_m, free_distance_);
    case CameraKind::kOnboard:
      return on_board(T_world_body);
    case CameraKind::kChase:
      break;
  }
  return chase(elapsed_s);
}

View CameraRig::on_board(const Pose3& T_world_body) const {
  const Pose3 T_world_level{T_world_body.position, quaternion_from_yaw(to_yaw(T_world_body.rotation))};
  View view = look_at(T_world_level * head_m_, T_world_level * (head_m_ + Eigen::Vector3d(4.0, 0.0, -0.25)));
  view.field_of_view_rad = 1.1;
  return view;
}

View CameraRig::chase(double elapsed_s) {
  constexpr double kReturn_s = 0.8, kRoof_s = 1.5;  // time constants; the approach is immediate
  constexpr double kClearance_m = 0.25;
  constexpr double kUp_m = 0.5;  // raises the target under a roof
  const Pose3 T_world_rig{*focus_m_, quaternion_from_yaw(heading_rad_)};
  const Eigen::Vector3d over_robot = T_world_rig * Eigen::Vector3d(0.0, 0.0, 0.4);
  const Eigen::Vector3d back = T_world_rig * Eigen::Vector3d(-2.4, 0.0, 1.15) - over_robot;
  double distance_fraction = 1.0;
  if (free_distance_) {
    const double wanted_m = back.norm() + kClearance_m;
    const double free_m = free_distance_(over_robot, back.normalized(), wanted_m);
    distance_fraction = std::clamp((free_m - kClearance_m) / back.norm(), 0.2, 1.0);
  }
  distance_fraction_ = std::min(distance_fraction, distance_fraction_ + (1.0 - std::exp(-elapsed_s / kReturn_s)) *
                                                                            (distance_fraction - distance_fraction_));
  roof_weight_ +=
      (1.0 - std::exp(-elapsed_s / kRoof_s)) * ((roof_height_m(*focus_m_, free_distance_) ? 1.0 : 0.0) - roof_weight_);
  return look_at(over_robot + distance_fraction_ * back, T_world_rig * Eigen::Vector3d(0.9, 0.0, kUp_m * roof_weight_));
}

}  // namespace patrol::render
