#include "render/film/shot_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/geometry/angles.h"

namespace patrol::render {
namespace {

constexpr double kClearance_m = 0.25;  // between camera and obstacle
constexpr double kFollow_s = 0.12;     // time constant
constexpr double kHigh_m = 2.0;        // subjects higher than this are seen from below

}  // namespace

ShotCamera::ShotCamera(Shot shot, FreeDistance free_distance, const Pose3& T_world_body)
    : shot_(std::move(shot)),
      free_distance_(std::move(free_distance)),
      focus_m_(focus_of(T_world_body)),
      bearing_rad_(choose_bearing(T_world_body)) {}

/// Point of interest: the robot, or a point between it and the subject of the shot.
Eigen::Vector3d ShotCamera::focus_of(const Pose3& T_world_body) const {
  constexpr double kTowardsSubject = 0.4;
  Eigen::Vector3d focus = T_world_body.position;
  focus.z() += 0.5 * shot_.subject_height_m;
  if (shot_.p_world_subject) focus.head<2>() += kTowardsSubject * (*shot_.p_world_subject - focus.head<2>());
  return focus;
}

/// Offset from the focus to the camera at a bearing of zero.
Eigen::Vector3d ShotCamera::offset_m(const Eigen::Vector3d& p_world_body) const {
  if (!shot_.p_world_subject) return {1.8, 0.0, 0.55};
  const double apart_m = std::hypot((*shot_.p_world_subject - p_world_body.head<2>()).norm(), shot_.subject_height_m);
  const double away_m = std::clamp(1.7 + 0.9 * apart_m, 2.2, 6.5);
  // A subject above the robot is seen from below, with the camera as high as the robot.
  if (shot_.subject_height_m > kHigh_m) return {away_m, 0.0, -0.5 * shot_.subject_height_m + 0.3};
  return {away_m, 0.0, 0.4 + 0.25 * away_m};
}

double ShotCamera::choose_bearing(const Pose3& T_world_body) const {
  // One subject: from the front rather than from behind, the view of the chase camera. Two subjects: across the line
  // between them, on the side of the robot, which is the smaller one.
  static constexpr std::array kBeside_deg = {40.0, -40.0, 75.0, -75.0, 110.0, -110.0, 150.0, -150.0};
  static constexpr std::array kOfTwo_deg = {120.0, -120.0, 145.0, -145.0, 95.0, -95.0, 70.0, -70.0};
  double ahead_rad = to_yaw(shot_.T_world_body.rotation);
  if (shot_.p_world_subject) {
    const Eigen::Vector2d to_subject = *shot_.p_world_subject - shot_.T_world_body.position.head<2>();
    ahead_rad = std::atan2(to_subject.y(), to_subject.x());
  }
  const auto& bearings_deg = shot_.p_world_subject ? kOfTwo_deg : kBeside_deg;
  const auto free_fraction = [&](const Pose3& at, double bearing_rad) {
    const Eigen::Vector3d offset = quaternion_from_yaw(bearing_rad) * offset_m(at.position);
    const double wanted_m = offset.norm() + kClearance_m;
    return free_distance_ ? free_distance_(focus_of(at), offset.normalized(), wanted_m) / wanted_m : 1.0;
  };
  double best_rad = ahead_rad + bearings_deg[0] * kDegree, best_fraction = 0.0;
  for (const double bearing_deg : bearings_deg) {
    const double bearing_rad = ahead_rad + bearing_deg * kDegree;
    const double fraction =
        std::min(free_fraction(shot_.T_world_body, bearing_rad), free_fraction(T_world_body, bearing_rad));
    if (fraction <= best_fraction) continue;
    best_fraction = fraction;
    best_rad = bearing_rad;
  }
  return best_rad;
}

View ShotCamera::from_above(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s) {
  constexpr double kLowest_m = 10.0, kHighest_m = 30.0, kHeightPerApart = 0.8;
  const Eigen::Vector2d apart_m = p_world_estimate - T_world_body.position.head<2>();
  Eigen::Vector3d between = T_world_body.position;
  between.head<2>() += 0.5 * apart_m;
  const double gain = 1.0 - std::exp(-elapsed_s / kFollow_s);
  focus_m_ += gain * (between - focus_m_);
  height_m_ += gain * (std::clamp(kHeightPerApart * apart_m.norm(), kLowest_m, kHighest_m) - height_m_);
  return look_down(focus_m_, height_m_, free_distance_);
}

View ShotCamera::follow(const Pose3& T_world_body, const Eigen::Vector2d& p_world_estimate, double elapsed_s) {
  constexpr double kReturn_s = 0.8;  // time constant; the approach is immediate
  constexpr double kSwing_radps = 3.0 * kDegree;
  constexpr double kAside = 0.07, kBelow = 0.08;  // fractions of the distance
  if (shot_.kind == ShotKind::kOverhead) return from_above(T_world_body, p_world_estimate, elapsed_s);
  focus_m_ += (1.0 - std::exp(-elapsed_s / kFollow_s)) * (focus_of(T_world_body) - focus_m_);
  bearing_rad_ += kSwing_radps * elapsed_s;
  const Eigen::Vector3d offset = quaternion_from_yaw(bearing_rad_) * offset_m(T_world_body.position);
  double distance_fraction = 1.0;
  if (free_distance_) {
    const double free_m = free_distance_(focus_m_, offset.normalized(), offset.norm() + kClearance_m);
    distance_fraction = std::clamp((free_m - kClearance_m) / offset.norm(), 0.3, 1.0);
  }
  distance_fraction_ = std::min(distance_fraction, distance_fraction_ + (1.0 - std::exp(-elapsed_s / kReturn_s)) *
                                                                            (distance_fraction - distance_fraction_));
  // Aim slightly right of and below the focus: the map inset covers that part of the picture, and the caption.
  const Eigen::Vector3d to_right = Eigen::Vector3d::UnitZ().cross(offset),
                        down = -offset.norm() * Eigen::Vector3d::UnitZ();
  return look_at(focus_m_ + distance_fraction_ * offset,
                 focus_m_ + distance_fraction_ * (kAside * to_right + kBelow * down));
}

}  // namespace patrol::render
