#pragma once

#include <array>
#include <string>

#include <Eigen/Geometry>

#include "core/robot_description.h"

namespace patrol::test {

/// Frame of one joint of a synthetic leg relative to the plain one: abduction about x, hip and knee about y, straight
/// down at zero.
struct UrdfLegFrame {
  Eigen::Quaterniond R_plain_joint = Eigen::Quaterniond::Identity();
  double sign = 1.0;      ///< sign of the angle
  double zero_rad = 0.0;  ///< plain angle at angle 0
};

/// Synthetic robot with four legs of 0.45 m by default, and an IMU and a lidar on its trunk. All lengths are in meters.
struct UrdfQuadruped {
  double mass_kg = 20.0;
  double leg_mass_ratio = 0.5;  ///< mass of the four legs relative to that of the robot
  double thigh_m = 0.22, shank_m = 0.23;
  double hip_spacing_m = 0.42, hip_width_m = 0.12;
  double abduction_offset_m = 0.08;
  double knee_offset_m = 0.0;  ///< lateral distance from the thigh's axis to that of the shank, outward
  double foot_radius_m = 0.022;
  double effort_nm = 40.0, knee_effort_nm = 60.0;
  double speed_radps = 25.0;
  double knee_lower_rad = -2.7, knee_upper_rad = -0.3;                    ///< plain angle
  double shank_collision_ratio = 0.9;                                     ///< size of its collision box to its looks
  bool is_hip_first = false;                                              ///< the hip is above the abduction
  std::array<UrdfLegFrame, 3> frames = {};                                ///< abduction, hip, knee
  std::array<std::string, 4> legs = {"alpha", "beta", "gamma", "delta"};  ///< front left, front right, rear left, right

  std::string text() const;

  /// Returns the plain joint angles (abduction, hip, knee) for angles in the order and the frames of the description.
  Eigen::Vector3d plain_angles(const Eigen::Vector3d& joint_rad) const;

  /// Returns a leg with the same plain geometry and no chain; FL, FR, RL, RR. Not for `is_hip_first`.
  LegGeometry plain_leg(int leg) const;
};

/// Frames like those of robots whose links are drawn in the frames of their actuators.
inline std::array<UrdfLegFrame, 3> actuator_frames() {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return {UrdfLegFrame{.R_plain_joint = Eigen::Quaterniond(AngleAxisd(1.5707963, Vector3d::UnitY())),
                       .sign = -1.0,
                       .zero_rad = 0.1},
          UrdfLegFrame{.R_plain_joint = AngleAxisd(-1.2, Vector3d::UnitZ()) * AngleAxisd(0.7, Vector3d::UnitX()) *
                                        AngleAxisd(0.3, Vector3d::UnitY()),
                       .sign = 1.0,
                       .zero_rad = 0.9},
          UrdfLegFrame{.R_plain_joint = Eigen::Quaterniond(AngleAxisd(3.1, Vector3d(0.6, 0.0, 0.8))),
                       .sign = -1.0,
                       .zero_rad = -1.5}};
}

}  // namespace patrol::test
