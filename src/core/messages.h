#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "core/event.h"
#include "core/frames.h"
#include "core/grid.h"
#include "core/inspection_result.h"
#include "core/time.h"
#include "core/trajectory.h"

/// Messages between the components of a robot. Sensor messages are in core/sensors/<name>.h, listed in
/// core/sensors/registry.h. SI units. A stamp is the instant at which the content is valid, not the instant of sending.
namespace patrol {

/// Velocity command, in `level`.
struct VelocityCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// Report of the firmware that the robot has fallen.
struct FallReport {
  Time stamp{};
};

/// Record of a turn of a stack: when its messages take effect, and when the next turn is.
struct StackTurnRecord {
  Time turn{};       ///< start of the turn
  Time delay{};      ///< time from the start until the messages of the turn take effect
  Time next_turn{};  ///< time that the stack asked for
  bool is_last = false;
  bool mission_is_over = false;
};

/// Request for one panoramic scan, taken at once. The robot stands still until the scan is complete.
struct ScanCommand {
  Time stamp{};
};

/// Target direction of the antenna, held until the next command.
struct AntennaCommand {
  Time stamp{};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// Request for one sounding, taken at once at the present antenna pose.
struct SoundingCommand {
  Time stamp{};
};

/// State of the warning light and the siren.
struct WarningCommand {
  Time stamp{};
  bool light = false;
  bool siren = false;
};

/// Command of the stack to the inspection instruments.
using InstrumentCommand = std::variant<ScanCommand, AntennaCommand, SoundingCommand, WarningCommand>;

/// Odometry estimate: pose of the body in `odom`, continuous but drifting.
struct OdometryEstimate {
  Time stamp{};
  Pose3 T_odom_body;
  Twist3 twist;                                                 ///< twist of the body, in body
  Eigen::Matrix3d planar_covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in odom; m, m, rad
};

/// Pose estimate of the level body in `map`.
struct PoseEstimate {
  Time stamp{};
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in map; m, m, rad
};

/// Pose estimate from odometry and UWB ranges alone, without map or lidar. Independent check of the localization.
struct UwbPoseEstimate : PoseEstimate {};

/// Self-assessment of the localization: its confidence and whether it is lost.
struct LocalizationConfidence {
  Time stamp{};
  double confidence = 0.0;             ///< confidence: 0 lost ... 1 certain
  double max_std_m = 0.0;              ///< largest principal standard deviation of the position
  double max_std_direction_rad = 0.0;  ///< direction of `max_std_m`, in map, -pi/2 ... pi/2
  bool is_lost = false;                ///< true when localization has reported failure
};

struct ParticleSet {
  Time stamp{};
  std::vector<Pose2> T_map_body;  ///< particle poses, [particle]
  std::vector<double> weights;    ///< weights, [particle], sum 1
};

struct MapUpdate {
  Time stamp{};
  OccupancyGrid map;  ///< map, in `map`
};

struct Path {
  Time stamp{};
  std::vector<Pose2> T_map_body;
};

/// Poses of the body in `map`, with all corrections of a SLAM method up to now.
struct TrajectoryEstimate {
  Time stamp{};
  std::vector<StampedPose> T_map_body;  ///< one pose per processed scan, in the order of the scans
};

/// Odometry of a recorded log, at the stamp of the first or of the last beam of a scan.
struct RecordedOdometry {
  Time stamp{};
  Pose2 T_odom_body;
};

/// 2D scan after motion compensation: beams in `level` at `stamp`, without beam ends on the ground.
struct LevelScan {
  struct Beam {
    Eigen::Vector2f end_m;  ///< end of the beam, in level: the hit, or the end of the free part
    bool is_hit;
  };
  Time stamp{};
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< position of the lidar, in level
  double tilt_rad = 0.0;  ///< tilt of the lidar's plane at the stamp; a strongly tilted plane cuts inclined walls off
                          ///< their mapped position
  std::vector<Beam> beams;
};

}  // namespace patrol
