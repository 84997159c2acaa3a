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

/// What the robot's parts say to each other: the same things a real robot would publish. SI units; stamps are the
/// instant that the content is true of, not when it was sent.
namespace patrol {

/// One revolution of a 2D lidar. Ranges follow REP 117: -Inf too close, +Inf no return, NaN invalid.
struct LaserScan {
  Time stamp{};  ///< instant of beam 0
  double angle_min_rad = 0.0;        ///< of beam 0, in `lidar`, about z
  double angle_increment_rad = 0.0;  ///< from beam to beam
  double time_increment_s = 0.0;     ///< from beam to beam
  double scan_time_s = 0.0;          ///< from scan to scan
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  std::vector<float> ranges_m;     ///< [beam]
  std::vector<float> intensities;  ///< [beam], 0 ... 255, or empty
};

struct CloudPoint {
  float x, y, z;     ///< m, in `lidar3d`
  float intensity;   ///< 0 ... 255
  float time_s;      ///< after the cloud's stamp
  std::uint16_t ring;
};

/// One revolution of a 3D lidar; only returns are kept.
struct PointCloud {
  Time stamp{};  ///< instant of the first firing
  std::vector<CloudPoint> points;
};

/// Specific force and rate, in `imu` (REP 145): at rest, level, the acceleration reads +g on z.
struct Imu {
  Time stamp{};
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_acceleration_mps2 = Eigen::Vector3d::Zero();
};

/// Joint encoders in the order of RobotDescription::joint_names.
struct JointState {
  Time stamp{};
  std::vector<double> position_rad;
  std::vector<double> velocity_radps;
  std::vector<double> effort_nm;
};

/// Force on each foot's sensor, in the order of RobotDescription::legs.
struct FootContacts {
  Time stamp{};
  std::vector<double> force_n;
};

/// Open-path laser methane meter (TDLAS). The instrument measures the column along its beam.
struct GasReading {
  Time stamp{};
  double column_ppm_m = 0.0;     ///< concentration integrated along the beam
  double path_length_m = 0.0;    ///< to the surface that scattered the beam back; +Inf if none did
  double mean_mg_m3 = 0.0;       ///< column over path length, as mass of methane at 20 degC and 1 atm
};

enum class GnssStatus : std::uint8_t { kNone, kFloat, kFix };

/// Antenna position in WGS 84.
struct GnssFix {
  Time stamp{};
  GnssStatus status = GnssStatus::kNone;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
  Eigen::Vector3d position_std_m = Eigen::Vector3d::Zero();  ///< east, north, up
};

/// Counts of the Hall sensors on the drive motors since power-up; forwards is positive.
struct TrackTicks {
  Time stamp{};
  std::int64_t left = 0;
  std::int64_t right = 0;
};

/// A two-way ultra-wideband range from the robot's antenna (frame `uwb`) to one anchor. A range that was lost is not sent.
struct UwbRange {
  Time stamp{};
  int anchor = 0;  ///< number of the anchor in the site's survey
  double range_m = 0.0;
};

/// One ping of one transducer of the ultrasonic ring: distance to the nearest echo within its cone, along x of its frame.
struct UltrasonicRange {
  Time stamp{};
  int transducer = 0;  ///< its frame is `ultrasonic_<transducer>`
  double field_of_view_rad = 0.0;  ///< full angle of the cone
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  float range_m = 0.0F;  ///< REP 117: -Inf too close, +Inf no echo
};

/// One frame of the infrared depth camera. A pixel (column u, row v, from the top left) of depth d shows the point
/// (d, -(u - cx) d / fx, -(v - cy) d / fy) in `depth_camera`, whose x axis is the optical axis.
struct DepthImage {
  Time stamp{};
  int width = 0;
  int height = 0;
  double fx_px = 0.0, fy_px = 0.0;
  double cx_px = 0.0, cy_px = 0.0;
  std::vector<std::uint16_t> depth_mm;  ///< [row][column], along the optical axis; 0 invalid
};

struct ScannerPoint {
  float x, y, z;    ///< m, in `scanner_level`
  float intensity;  ///< 0 ... 255
};

/// A still panoramic scan of the 3D scanner; only returns are kept, in the order of its columns. `scanner_level` has the origin and
/// the heading of `scanner`, and is level: the instrument's own compensator has taken out the tilt that it reads.
struct PanoramicScan {
  Time stamp{};  ///< instant of the last point
  std::vector<ScannerPoint> points;
};

/// What the servos of the antenna mount read back: the coil's axis is x of `tem`, turned by yaw (to the left) and then by pitch
/// (downwards, as REP 103 counts it).
struct AntennaState {
  Time stamp{};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// A transient-electromagnetic sounding, stacked: after the current in the coil is switched off, the rate of change of the magnetic
/// field along the coil's axis.
struct TemSounding {
  Time stamp{};                    ///< of its end
  double moment_am2 = 0.0;         ///< of the transmitter
  std::vector<double> gate_s;      ///< [gate]: middle, after the end of the current's ramp
  std::vector<double> rate_tps;    ///< [gate]: -dB/dt, T/s
  std::vector<double> std_tps;     ///< [gate]: of the mean over the stack, as the instrument estimates it
};

/// The velocity asked of the robot, in `level`.
struct VelocityCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// What the person at the remote control does: the velocity asked for, and two buttons.
struct RemoteCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  bool mark = false;       ///< pressed now: this place is a goal
  bool hand_over = false;  ///< pressed now: the robot goes on by itself
};

/// What the sensors say, and the person at the remote control.
using SensorMessage = std::variant<LaserScan, PointCloud, Imu, JointState, FootContacts, GasReading, GnssFix, TrackTicks,
                                   UwbRange, UltrasonicRange, DepthImage, RemoteCommand, PanoramicScan, AntennaState, TemSounding>;

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
