#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/error.h"
#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/site/site_registration.h"

/// Conversion of messages to ROS 2 messages: the ROS type of each message and its CDR encoding (little-endian XCDR1
/// with its four-byte header). `encode` and `decode` share one description of the fields, in ros_messages.cc,
/// ros_sensor_messages.cc, ros_inspection_messages.cc and, one file for each further sensor, sensors/<name>.cc.
namespace patrol::io {

/// Transform of /tf and /tf_static.
struct FrameTransform {
  Time stamp{};
  std::string parent, child;
  Pose3 T_parent_child;
};
struct TransformSet {
  std::vector<FrameTransform> transforms;
};

/// Scans of a keyframe of a map, in the frame of the keyframe. As a point cloud with the fields x, y, z (end of a
/// beam), vp_x, vp_y, vp_z (position of the lidar, named as in PCL's PointWithViewpoint), scan (index, uint16) and hit
/// (uint8; 0: the beam was free up to its end).
struct KeyframeScans {
  Time stamp{};                  ///< stamp of the newest scan
  std::vector<LevelScan> scans;  ///< oldest first
};

template <typename Message>
inline constexpr const char* kRosType = nullptr;
template <IsSensorMessage Message>
inline constexpr const char* kRosType<Message> = SensorTraits<Message>::kInfo.ros_type;
template <>
inline constexpr const char* kRosType<ScanCommand> = "patrol_msgs/msg/ScanCommand";
template <>
inline constexpr const char* kRosType<AntennaCommand> = "patrol_msgs/msg/AntennaCommand";
template <>
inline constexpr const char* kRosType<SoundingCommand> = "patrol_msgs/msg/SoundingCommand";
template <>
inline constexpr const char* kRosType<WarningCommand> = "patrol_msgs/msg/WarningCommand";
template <>
inline constexpr const char* kRosType<LiningResult> = "patrol_msgs/msg/LiningResult";
template <>
inline constexpr const char* kRosType<WaterResult> = "patrol_msgs/msg/WaterResult";
template <>
inline constexpr const char* kRosType<LocalizationConfidence> = "patrol_msgs/msg/LocalizationConfidence";
template <>
inline constexpr const char* kRosType<CalibrationEstimate> = "patrol_msgs/msg/CalibrationEstimate";
template <>
inline constexpr const char* kRosType<OdometryEstimate> = "nav_msgs/msg/Odometry";
template <>
inline constexpr const char* kRosType<UwbPoseEstimate> = "geometry_msgs/msg/PoseWithCovarianceStamped";
template <>
inline constexpr const char* kRosType<PoseEstimate> = "geometry_msgs/msg/PoseWithCovarianceStamped";
template <>
inline constexpr const char* kRosType<SiteRegistration> = "geometry_msgs/msg/PoseWithCovarianceStamped";
template <>
inline constexpr const char* kRosType<ParticleSet> = "nav2_msgs/msg/ParticleCloud";
template <>
inline constexpr const char* kRosType<MapUpdate> = "nav_msgs/msg/OccupancyGrid";
template <>
inline constexpr const char* kRosType<Path> = "nav_msgs/msg/Path";
template <>
inline constexpr const char* kRosType<TrajectoryEstimate> = "nav_msgs/msg/Path";
template <>
inline constexpr const char* kRosType<RecordedOdometry> = "nav_msgs/msg/Odometry";
template <>
inline constexpr const char* kRosType<VelocityCommand> = "geometry_msgs/msg/TwistStamped";
template <>
inline constexpr const char* kRosType<Event> = "patrol_msgs/msg/Event";
template <>
inline constexpr const char* kRosType<FallReport> = "patrol_msgs/msg/FallReport";
template <>
inline constexpr const char* kRosType<StackTurnRecord> = "patrol_msgs/msg/StackTurn";
template <>
inline constexpr const char* kRosType<GroundTruth> = "nav_msgs/msg/Odometry";
template <>
inline constexpr const char* kRosType<SimState> = "patrol_msgs/msg/SimState";
template <>
inline constexpr const char* kRosType<AsBuiltTruth> = "patrol_msgs/msg/NamedValues";
template <>
inline constexpr const char* kRosType<Collision> = "patrol_msgs/msg/Collision";
template <>
inline constexpr const char* kRosType<KeyframeScans> = "sensor_msgs/msg/PointCloud2";
template <>
inline constexpr const char* kRosType<TransformSet> = "tf2_msgs/msg/TFMessage";

/// Names that ROS messages contain and messages of the program do not.
struct RosNames {
  std::vector<std::string> joints;
};

template <typename Message>
std::string encode(const Message& message, const RosNames& names = {});

/// Returns the fields of the ROS type of a sensor message, in the format of a .msg file; empty if ros_definitions.cc
/// contains them.
template <IsSensorMessage Message>
std::string_view ros_message_fields();

/// Bytes that are not a message of the expected type.
class DecodeError : public InputError {
 public:
  using InputError::InputError;
};

/// Throws DecodeError.
template <typename Message>
Message decode(std::string_view bytes);

/// Returns whether all floating-point fields of a message are finite.
template <typename Message>
bool has_finite_numbers(const Message& message);

/// Returns whether the norms of all quaternions in the bytes of a message are 1, to 0.001. Throws DecodeError.
template <typename Message>
bool has_unit_quaternions(std::string_view bytes);

/// Header of a message, as it is in the bytes.
struct MessageHeader {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;  ///< below 1e9 in a valid message
  std::string frame;

  Time stamp() const { return std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds); }
};
/// Returns the header of a message that begins with one. Throws DecodeError.
MessageHeader header_of(std::string_view bytes);

/// Frames of a nav_msgs/Odometry: header.frame_id and child_frame_id.
struct OdometryFrames {
  std::string frame, child;
};
OdometryFrames odometry_frames_of(std::string_view bytes);

}  // namespace patrol::io
