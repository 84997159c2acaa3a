// Codecs of sensor messages and teleoperation commands.
#include <cmath>
#include <cstring>
#include <utility>

#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, LaserScan& scan) {
  scan_fields(codec, scan, "lidar");
}

template <typename Codec>
void describe(Codec& codec, PointCloud& cloud) {
  header(codec, cloud.stamp, "lidar3d");
  // Point layout of LIO-SAM: x y z intensity (float32), ring (uint16), time (float32).
  constexpr std::uint32_t kStep = 22;
  cloud_layout(codec, static_cast<std::uint32_t>(cloud.points.size()), kStep,
               {{"x", 0, kFloat32},
                {"y", 4, kFloat32},
                {"z", 8, kFloat32},
                {"intensity", 12, kFloat32},
                {"ring", 16, kUint16},
                {"time", 18, kFloat32}});
  std::vector<std::uint8_t> data(std::size_t{kStep} * cloud.points.size());
  for (std::size_t i = 0; Codec::kWrites && i < cloud.points.size(); ++i) {
    const CloudPoint& point = cloud.points[i];
    std::uint8_t* to = data.data() + kStep * i;
    const float values[4] = {point.x, point.y, point.z, point.intensity};
    std::memcpy(to, values, 16);
    std::memcpy(to + 16, &point.ring, 2);
    std::memcpy(to + 18, &point.time_s, 4);
  }
  codec(data);
  bool is_dense = true;
  codec(is_dense);
  if constexpr (!Codec::kWrites) {
    cloud.points.resize(data.size() / kStep);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      CloudPoint& point = cloud.points[i];
      const std::uint8_t* from = data.data() + kStep * i;
      std::memcpy(&point.x, from, 4);
      std::memcpy(&point.y, from + 4, 4);
      std::memcpy(&point.z, from + 8, 4);
      std::memcpy(&point.intensity, from + 12, 4);
      std::memcpy(&point.ring, from + 16, 2);
      std::memcpy(&point.time_s, from + 18, 4);
    }
  }
}

template <typename Codec>
void describe(Codec& codec, Imu& imu) {
  header(codec, imu.stamp, "imu");
  Pose3 no_orientation;
  codec(no_orientation.rotation.x());
  codec(no_orientation.rotation.y());
  codec(no_orientation.rotation.z());
  codec(no_orientation.rotation.w());
  std::array<double, 9> unknown{}, unstated{};
  unknown[0] = -1.0;  // REP 145: the IMU gives no orientation
  codec(unknown);
  vector3(codec, imu.angular_velocity_radps);
  codec(unstated);
  vector3(codec, imu.linear_acceleration_mps2);
  codec(unstated);
}

template <typename Codec>
void describe(Codec& codec, JointState& joints) {
  header(codec, joints.stamp, frame_id::kBody);
  std::vector<std::string> names = codec.names.joints;
  codec(names);
  codec(joints.position_rad);
  codec(joints.velocity_radps);
  codec(joints.effort_nm);
}

template <typename Codec>
void describe(Codec& codec, FootContacts& contacts) {
  header(codec, contacts.stamp, frame_id::kBody);
  codec(contacts.force_n);
}

template <typename Codec>
void describe(Codec& codec, GasReading& reading) {
  header(codec, reading.stamp, "tdlas");
  codec(reading.column_ppm_m);
  codec(reading.path_length_m);
  codec(reading.mean_mg_m3);
}

template <typename Codec>
void describe(Codec& codec, GnssFix& fix) {
  header(codec, fix.stamp, "gnss");
  // RTK with fixed ambiguities is a ground-based augmentation (STATUS_GBAS_FIX); float goes as a plain fix.
  std::int8_t status = fix.status == GnssStatus::kNone ? -1 : fix.status == GnssStatus::kFix ? 2 : 0;
  std::uint16_t service = 1 | 2 | 4 | 8;
  codec(status);
  codec(service);
  fix.status = status < 0 ? GnssStatus::kNone : status == 2 ? GnssStatus::kFix : GnssStatus::kFloat;
  codec(fix.latitude_deg);
  codec(fix.longitude_deg);
  codec(fix.altitude_m);
  std::array<double, 9> covariance{};
  for (std::size_t i = 0; i < 3; ++i)
    covariance[4 * i] = fix.position_std_m[static_cast<int>(i)] * fix.position_std_m[static_cast<int>(i)];
  codec(covariance);
  if constexpr (!Codec::kWrites) {
    for (std::size_t i = 0; i < 3; ++i) fix.position_std_m[static_cast<int>(i)] = std::sqrt(covariance[4 * i]);
  }
  std::uint8_t diagonal_known = 2;
  codec(diagonal_known);
}

template <typename Codec>
void describe(Codec& codec, TrackTicks& ticks) {
  header(codec, ticks.stamp, frame_id::kBody);
  codec(ticks.left);
  codec(ticks.right);
}

template <typename Codec>
void describe(Codec& codec, UwbRange& range) {
  header(codec, range.stamp, "uwb");
  auto anchor = static_cast<std::int32_t>(range.anchor);
  codec(anchor);
  range.anchor = anchor;
  codec(range.range_m);
}

template <typename Codec>
void describe(Codec& codec, UltrasonicRange& range) {
  const std::string prefix = "ultrasonic_";
  time_field(codec, range.stamp);
  std::string frame = prefix + std::to_string(range.transducer);
  codec(frame);
  if constexpr (!Codec::kWrites) {
    const std::string number = frame.starts_with(prefix) ? frame.substr(prefix.size()) : "";
    if (number.empty() || number.size() > 4 || number.find_first_not_of("0123456789") != std::string::npos) {
      throw DecodeError("unknown frame of an ultrasonic range: must be ultrasonic_<number>");
    }
    range.transducer = std::stoi(number);
  }
  std::uint8_t ultrasound = 0;
  codec(ultrasound);
  float_field(codec, range.field_of_view_rad);
  float_field(codec, range.range_min_m);
  float_field(codec, range.range_max_m);
  codec(range.range_m);
}

template <typename Codec>
void describe(Codec& codec, DepthImage& image) {
  header(codec, image.stamp, "depth_camera");
  auto height = static_cast<std::uint32_t>(image.height), width = static_cast<std::uint32_t>(image.width);
  codec(height);
  codec(width);
  std::string encoding = "16UC1";
  codec(encoding);
  bool is_big_endian = false;
  codec(is_big_endian);
  std::uint32_t row_step = 2 * width;
  codec(row_step);
  std::vector<std::uint8_t> bytes(2 * image.depth_mm.size());
  if constexpr (Codec::kWrites) std::memcpy(bytes.data(), image.depth_mm.data(), bytes.size());
  codec(bytes);
  if constexpr (!Codec::kWrites) {
    if (bytes.size() != std::size_t{2} * width * height)
      throw DecodeError("number of pixels does not match the image size");
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.depth_mm.resize(bytes.size() / 2);
    std::memcpy(image.depth_mm.data(), bytes.data(), bytes.size());
  }
  codec(image.fx_px);
  codec(image.fy_px);
  codec(image.cx_px);
  codec(image.cy_px);
}

template <typename Codec>
void describe(Codec& codec, TeleopCommand& command) {
  header(codec, command.stamp, frame_id::kLevel);
  codec(command.vx_mps);
  codec(command.yaw_rate_radps);
  codec(command.save_goal);
  codec(command.hand_over);
}

}  // namespace patrol::io::ros

namespace patrol::io {

PATROL_ROS_SENSOR(LaserScan, ros::kLaserScanFields);
PATROL_ROS_SENSOR(PointCloud, "");
PATROL_ROS_SENSOR(Imu,
                  "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
                  "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
                  "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n");
PATROL_ROS_SENSOR(JointState,
                  "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n");
PATROL_ROS_SENSOR(
    FootContacts,
    "# Force on each foot's sensor, N, in the order FL, FR, RL, RR.\nstd_msgs/Header header\nfloat64[] force_n\n");
PATROL_ROS_SENSOR(
    GasReading,
    "# Open-path methane meter: column along the beam, length of the beam (inf: no return), mean as mass of methane.\n"
    "std_msgs/Header header\nfloat64 column_ppm_m\nfloat64 path_length_m\nfloat64 mean_mg_m3\n");
PATROL_ROS_SENSOR(
    GnssFix,
    "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n"
    "float64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
    "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n");
PATROL_ROS_SENSOR(TrackTicks,
                  "# Counts of the drive motors' Hall sensors since power-up; forwards is positive.\n"
                  "std_msgs/Header header\nint64 left\nint64 right\n");
PATROL_ROS_SENSOR(UwbRange,
                  "# Two-way range, m, from the robot's antenna to the anchor of that number.\n"
                  "std_msgs/Header header\nint32 anchor\nfloat64 range_m\n");
PATROL_ROS_SENSOR(
    UltrasonicRange,
    "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\nfloat32 field_of_view\n"
    "float32 min_range\nfloat32 max_range\nfloat32 range\n");
PATROL_ROS_SENSOR(DepthImage,
                  "# The fields of a sensor_msgs/Image (16UC1: depth along the optical axis, mm, 0 invalid), and the "
                  "pinhole parameters, pixels.\n"
                  "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
                  "step\nuint8[] data\n"
                  "float64 fx_px\nfloat64 fy_px\nfloat64 cx_px\nfloat64 cy_px\n");
PATROL_ROS_SENSOR(TeleopCommand,
                  "# Teleoperation command. Buttons: save the current pose as a goal; switch to autonomous mode.\n"
                  "std_msgs/Header header\nfloat64 vx_mps\nfloat64 yaw_rate_radps\nbool save_goal\nbool hand_over\n");

}  // namespace patrol::io
