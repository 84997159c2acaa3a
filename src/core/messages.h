#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/event.h"
#include "core/frames.h"
#include "core/grid.h"
#include "core/inspection_result.h"
#include "core/time.h"

/// Messages between the robot's parts, as on a real robot. Those of sensors are in core/sensors/<name>.h, listed in
/// core/sensors/registry.h. SI units; a stamp is the instant that the content is true of, not the instant of sending.
namespace patrol {

/// The velocity asked of the robot, in `level`.
struct VelocityCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// One panoramic scan, now; the robot stands still until it is there.
struct ScanCommand {
  Time stamp{};
};

/// Turn the antenna there, and hold it.
struct AntennaCommand {
  Time stamp{};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// One sounding, now, where the antenna is.
struct SoundingCommand {
  Time stamp{};
};

/// Warning light and siren.
struct WarningCommand {
  Time stamp{};
  bool light = false;
  bool siren = false;
};

/// What the stack asks of the inspection's instruments.
using InstrumentCommand = std::variant<ScanCommand, AntennaCommand, SoundingCommand, WarningCommand>;

/// Smooth, drifting: the body in `odom`.
struct OdometryEstimate {
  Time stamp{};
  Pose3 T_odom_body;
  Twist3 twist;  ///< in body
  Eigen::Matrix3d planar_covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in odom; m, m, rad
};

/// The level body in `map`.
struct PoseEstimate {
  Time stamp{};
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in map; m, m, rad
};

/// The same by odometry and UWB ranges alone, without map or lidar: a second opinion.
struct RangePoseEstimate : PoseEstimate {};

/// How far the localisation believes itself: "am I lost?".
struct LocalizationTrust {
  Time stamp{};
  double trust = 0.0;          ///< 0 lost ... 1 sure
  double weak_std_m = 0.0;     ///< standard deviation of the position along its weakest direction
  double weak_direction_rad = 0.0;  ///< that direction, in map, -pi/2 ... pi/2
  bool is_lost = false;        ///< the robot does not know where it is, and says so
};

struct ParticleSet {
  Time stamp{};
  std::vector<Pose2> T_map_body;  ///< [particle]
  std::vector<double> weights;    ///< [particle], sum 1
};

struct MapUpdate {
  Time stamp{};
  OccupancyGrid map;  ///< in `map`
};

struct Path {
  Time stamp{};
  std::vector<Pose2> T_map_body;
};

/// A 2D scan freed of the robot's motion: beams in `level` at `stamp`, ends that hit the ground removed.
struct LevelScan {
  struct Beam {
    Eigen::Vector2f end_m;  ///< in level; the hit, or where the beam was last known free
    bool is_hit;
  };
  Time stamp{};
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< the lidar, in level
  double tilt_rad = 0.0;  ///< of the lidar's plane at the stamp: tilted far, it cuts walls that lean elsewhere than a map has them
  std::vector<Beam> beams;
};

}  // namespace patrol
