#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "importer/leg_finder.h"
#include "importer/normalize.h"
#include "importer/wheel_finder.h"

namespace patrol::importer {

/// Returns the message about a robot all of whose wheels are steered.
inline std::string all_steered(std::size_t num_wheels) {
  return fmt::format("all {} wheels are steered: not supported: fix the steering joints of one axle", num_wheels);
}

/// Returns the angle of an axle relative to y of the base, in (-pi/2, pi/2].
inline double axle_angle_rad(const Eigen::Vector3d& axis) {
  double angle = std::atan2(-axis.x(), axis.y());
  if (angle <= -0.5 * std::numbers::pi + 1e-9) angle += std::numbers::pi;
  if (angle > 0.5 * std::numbers::pi + 1e-9) angle -= std::numbers::pi;
  return angle;
}

inline constexpr double kFriction = 0.8;          // rubber on asphalt
inline constexpr double kDensity_kgpm3 = 500.0;   // of a link without mass
inline constexpr double kMinSteering_rad = 0.05;  // to each side
inline constexpr double kSteering_rad = 0.6;      // to each side, of a joint without limits
inline constexpr double kParallel_rad = 0.0447;   // 2.6 degrees, as io/urdf.cc
inline constexpr double kAssumedSpeed_mps = 1.5;
inline constexpr double kSupportMassRatio = 0.03;  // of balls in place of fixed supports, to the robot
inline constexpr std::size_t kManyTriangles = 20000;
inline constexpr std::array kSensorFrames = {"lidar", "lidar_rear",   "lidar3d", "imu",
                                             "gnss",  "depth_camera", "tdlas",   "uwb"};

inline Pose3 translation(const Eigen::Vector3d& position) { return {.position = position}; }

/// Returns whether a name of a link has a meaning in Patrol.
inline bool is_reserved_link(const std::string& name) {
  static const std::set<std::string> kReserved = {
      "base_link",   "world",         "scanner",        "tem_mount",      "tem", "left_track",
      "right_track", "left_sprocket", "right_sprocket", "base_footprint", "map", "odom"};
  return kReserved.contains(name) ||
         std::find(kSensorFrames.begin(), kSensorFrames.end(), name) != kSensorFrames.end() ||
         name.starts_with("ultrasonic_");
}

inline bool is_reserved_joint(const std::string& name) { return name.starts_with("tem_") || name == "robot"; }

/// Returns a file name of ASCII letters, digits and underscores.
inline std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const bool is_plain =
        static_cast<unsigned char>(c) < 128 && (std::isalnum(static_cast<unsigned char>(c)) || c == '-');
    if (is_plain) stem += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!stem.ends_with('_')) stem += '_';
  }
  return stem.empty() || stem == "_" ? "mesh" : stem;
}

inline std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

inline Inertial to_inertial(const SourceInertial& source) {
  return {.mass_kg = source.mass_kg, .T_link_inertia = source.T_link_inertia, .inertia = source.inertia};
}

/// Part without a motor that slides on the ground: center in the base and radius.
struct Support {
  std::string name;
  Eigen::Vector3d center_m;
  double radius_m;
  std::string link;  ///< link of the file from which mass is taken; empty: base
};

/// Turns one description into the result.
class Normalizer {
 public:
  Normalizer(const SourceRobot& source, const NormalizeOptions& options)
      : source_(source), options_(options), T_root_link_(link_poses(source)) {
    result_.name = options.name.empty() ? source.name : options.name;
    result_.assumptions = source.assumptions;
  }

  NormalizedRobot run();

 private:
  void check_options() const;
  void assume(const std::string& subject, const std::string& text, const std::string& override_with) {
    result_.assumptions.push_back({subject, text, override_with});
  }
  void find_drive();
  void choose_base();
  void level_base();
  void choose_frame();
  void choose_legged_frame();
  void check_upright() const;
  void measure_box();
  void check_centers() const;
  void check_caster(const FoundWheel& wheel) const;
  void choose_carriers();
  [[noreturn]] void fail_for_wheels(const SourceJoint* joint, const std::string& what) const;
  void choose_drive();
  void release_fixed_casters();
  void choose_rollers();
  void check_fixed_sides(const std::vector<const FoundWheel*>& wheels) const;
  void report_frozen_joints();
  void reserve_names();
  std::string unique(std::set<std::string>& used, const std::string& wanted, const std::string& suffix) const;
  std::string link_name(const std::string& source_name);
  std::string joint_name(const std::string& source_name);
  Pose3 T_base(const std::string& link) const { return T_root_base_.inverse() * T_root_link_.at(link); }
  bool is_near_ground(double bottom_m) const;

  void add_chassis();
  void add_wheels();
  /// Ball at the end of a leg, in the frame of the last joint.
  struct Foot {
    Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
    std::string link = {};   ///< link of the file whose collision shape it is; empty: none
    bool is_sphere = false;  ///< the file has this ball
  };
  Foot find_foot(const FoundLeg& leg);
  Motor motor_of_leg(const SourceJoint& joint, double mass_kg, double leg_m);
  JointRange range_of_leg(const SourceJoint& joint);
  void keep_foot_free(const Foot& foot, const SourceJoint& knee, NormalizedLink& shank);
  Shape shank_of(const Foot& foot) const;
  void add_legs();
  void check_legged_balance();
  void refuse_unturned_wheels() const;
  void add_supports();
  double take_from_base(double wanted_kg);
  void strengthen_casters(double robot_mass_kg);
  void add_support(const Support& support, double robot_mass_kg);
  void add_sensors();
  void check_balance();
  void check_clearance();
  void check_ramps();
  void check_mass();
  std::vector<SourceSensor> sensors_in_order();
  void add_frame(const std::string& frame, const Pose3& T_base_frame, const std::string& link);
  void move_housing(const std::string& frame, const std::string& link);
  void clear_origin(const std::string& frame, const std::string& link);
  void check_scan_plane(const std::string& frame);
  std::optional<std::string> frame_by_option(const SourceSensor& sensor) const;
  void choose_lidar(const std::string& frame, const LidarNumbers& stated);
  void choose_scan_band();
  void report_frictions();
  void choose_keep_out_margin(double width_m);
  void check_densities();
  void finish();

  std::vector<const SourceLink*> moving_group(const SourceJoint& joint) const;
  Inertial moving_inertial(const std::vector<const SourceLink*>& links, const Pose3& T_base_new, const Pose3& T_adjust,
                           const std::vector<Shape>& fallback, const SourceJoint& joint);
  std::optional<Inertial> checked_inertial(const SourceLink& link);
  Inertial solid_inertial(const std::vector<Shape>& shapes, double mass_kg) const;
  void add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target);
  void add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals, NormalizedLink& target);
  std::string add_mesh(const std::string& stem, const Mesh& mesh);
  double total_mass_kg() const;
  void reduce_losses(const SourceJoint& joint, double radius_m, double traction_nm, NormalizedJoint& driven);
  void replace_heavy_inertia(const FoundWheel& wheel, const Shape& tread, Inertial& inertial);
  JointRange steering_range_of(const SourceJoint& joint);
  double speed_of(const FoundWheel& wheel, const Motor& motor);
  Motor motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg);
  NormalizedLink& base() { return result_.links.front(); }

  const SourceRobot& source_;
  const NormalizeOptions& options_;
  std::map<std::string, Pose3> T_root_link_;
  std::vector<FoundLeg> legs_;  ///< four; none for a robot on wheels
  FoundWheels found_;
  std::set<const SourceJoint*> kept_;     ///< movable joints of the result
  std::set<const SourceJoint*> driven_;   ///< wheel joints with motors
  std::set<const SourceJoint*> casters_;  ///< wheel joints that are replaced by supports
  std::set<std::string> chassis_;         ///< links of the base's rigid group
  std::string base_;                      ///< link of the file
  Pose3 T_root_base_;
  double source_kg_ = 0.0;   ///< mass of the file
  Eigen::AlignedBox3d box_;  ///< bounding box of all shapes, in the root
  double ground_m_ = 0.0;    ///< height of the ground in the base
  std::set<std::string> used_links_, used_joints_;
  std::map<std::string, std::string> link_names_, joint_names_;  ///< source to result
  std::map<const void*, std::vector<std::pair<std::string, std::optional<Eigen::Vector4d>>>> mesh_files_;
  std::map<const void*, std::vector<std::string>> hull_files_;
  std::set<std::string> used_files_;
  std::set<std::pair<std::string, std::size_t>> support_shapes_;  ///< link and index of collisions made into supports
  std::vector<Support> supports_;
  std::vector<std::string> massless_;
  NormalizedRobot result_;
};

}  // namespace patrol::importer
