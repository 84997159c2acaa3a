#include "io/ros/ros_definitions.h"

#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "io/ros/ros_messages.h"

namespace patrol::io {
namespace {

/// Fields of a type, as in common_interfaces of ROS 2, without comments; fields of patrol_msgs have units. The fields
/// of sensor types are next to their codecs (ros_message_fields).
struct Definition {
  std::string_view type, fields;
};

constexpr Definition kDefinitions[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/PoseWithCovarianceStamped", "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
     "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
     "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/NavSatStatus",
     "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nint8 status\n"
     "uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\nuint16 "
     "service\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose "
     "origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    {"nav2_msgs/Particle", "geometry_msgs/Pose pose\nfloat64 weight\n"},
    {"nav2_msgs/ParticleCloud", "std_msgs/Header header\nnav2_msgs/Particle[] particles\n"},
    {"patrol_msgs/ScanCommand", "# Request for one panoramic scan.\nstd_msgs/Header header\n"},
    {"patrol_msgs/AntennaCommand",
     "# Orientation of the antenna.\nstd_msgs/Header header\nfloat64 yaw_rad\nfloat64 pitch_rad\n"},
    {"patrol_msgs/SoundingCommand", "# Request for one sounding.\nstd_msgs/Header header\n"},
    {"patrol_msgs/WarningCommand", "# Warning light and siren.\nstd_msgs/Header header\nbool light\nbool siren\n"},
    {"patrol_msgs/LiningCell",
     "# Displacement of one cell of a lining ring, relative to the reference scan; inward is positive.\n"
     "int32 ring\nfloat64 clock_deg\nfloat64 inward_m\nfloat64 std_m\nint32 points\n"},
    {"patrol_msgs/ConvergenceLine",
     "# Change in length of a chord between two points of a ring; lengthening is positive.\nint32 ring\nstring "
     "name\nfloat64 change_m\nfloat64 std_m\n"},
    {"patrol_msgs/RingFinding",
     "uint8 NONE=0\nuint8 NOTICE=1\nuint8 WARNING=2\nuint8 ALARM=3\n"
     "int32 ring\nfloat64 clock_deg\nfloat64 inward_m\nfloat64 std_m\nuint8 level\ngeometry_msgs/Point position\n"},
    {"patrol_msgs/LiningResult",
     "# Lining deformation around a station, from a panoramic scan and the reference scan; pose of the body in map.\n"
     "std_msgs/Header header\nstring station\ngeometry_msgs/Pose pose\nbool is_registered\nfloat64 registration_rms_m\n"
     "float64 registration_inlier_ratio\nfloat64 correction_m\npatrol_msgs/LiningCell[] "
     "cells\npatrol_msgs/ConvergenceLine[] lines\n"
     "patrol_msgs/RingFinding[] findings\n"},
    {"patrol_msgs/WaterResult",
     "# Water ahead of the face, from the soundings of one station (src/core/inspection_result.h).\n"
     "uint8 NONE=0\nuint8 NOTICE=1\nuint8 WARNING=2\nuint8 ALARM=3\n"
     "std_msgs/Header header\nstring station\ngeometry_msgs/Pose pose\nint32 soundings\nfloat64 "
     "antenna_error_deg\nfloat64 rock_spm\n"
     "float64 evidence\nbool is_found\nuint8 level\ngeometry_msgs/Point position\nfloat64[9] covariance_m2\nfloat64 "
     "distance_m\n"
     "float64 distance_low_m\nfloat64 distance_high_m\nfloat64 azimuth_deg\nfloat64 elevation_deg\nfloat64 radius_m\n"
     "float64 radius_low_m\nfloat64 radius_high_m\n"},
    {"patrol_msgs/LocalizationConfidence",
     "# Confidence 0 (lost) ... 1 (certain); largest principal standard deviation of the position, and its direction "
     "in map.\n"
     "std_msgs/Header header\nfloat64 confidence\nfloat64 max_std_m\nfloat64 max_std_direction_rad\nbool is_lost\n"},
    {"patrol_msgs/CalibrationValue",
     "# Estimate of one calibration parameter; unit and meaning by its name "
     "(src/core/calibration/calibration_estimate.h).\n"
     "string name\nfloat64 value\nfloat64 std\n"},
    {"patrol_msgs/CalibrationEstimate",
     "# Estimates of the calibration parameters of the robot.\n"
     "std_msgs/Header header\npatrol_msgs/CalibrationValue[] values\n"},
    {"patrol_msgs/Event",
     "# Event of the mission; pose: estimated pose of the robot, target: position of the object; in map.\n"
     "std_msgs/Header header\nstring kind\nstring subject\nstring text\nfloat64 value\ngeometry_msgs/Pose pose\n"
     "geometry_msgs/Point target\n"},
    {"patrol_msgs/SimState",
     "# State of the simulator for the replay: qpos of MuJoCo, and x y z qw qx qy qz of each mocap body.\n"
     "std_msgs/Header header\nfloat64[] qpos\nfloat64[] mocap\n"},
    {"patrol_msgs/NamedValue", "string name\nfloat64 value\n"},
    {"patrol_msgs/NamedValues",
     "# Values by name; the unit is in the name.\nstd_msgs/Header header\npatrol_msgs/NamedValue[] values\n"},
    {"patrol_msgs/Collision",
     "# Contact of geom `first` of the robot with geom `second`.\nstd_msgs/Header header\nstring first\nstring "
     "second\n"},
    {"patrol_msgs/FallReport", "# Report of the firmware that the robot has fallen.\nstd_msgs/Header header\n"},
    {"patrol_msgs/StackTurn",
     "# Turn of the stack: the time from its start until its messages take effect, and the time of the next one.\n"
     "builtin_interfaces/Time turn\nbuiltin_interfaces/Duration delay\nbuiltin_interfaces/Time next_turn\n"
     "bool is_last\nbool mission_is_over\n"},
    {"patrol_msgs/LinkHello",
     "# First message of the simulator: limits of the base's velocity, URDF of the robot, survey of the site, goals, "
     "registration of the known map (JSON), settings (YAML).\n"
     "uint32 protocol\nstring program\nstring scenario\nuint64 seed\nbuiltin_interfaces/Duration tick\n"
     "float64 forward_mps\nfloat64 backward_mps\nfloat64 sideways_mps\nfloat64 yaw_rate_radps\n"
     "string robot\nstring site\nstring goals\nstring registration\nstring documents\n"},
    {"patrol_msgs/LinkHelloReply",
     "# Answer of the stack; no topics: all.\n"
     "uint32 protocol\nstring stack\nstring[] topics\nbuiltin_interfaces/Duration turn_period\n"},
    {"patrol_msgs/LinkTurn",
     "# Turn of the stack, after all messages that are due.\nbuiltin_interfaces/Time now\nbool is_last\n"},
    {"patrol_msgs/LinkDone",
     "# End of the turn at `now`, after all messages of the stack.\n"
     "builtin_interfaces/Time now\nbuiltin_interfaces/Time next_turn\nbool mission_is_over\n"},
    {"patrol_msgs/LinkFailure", "# Reason for the end of the connection.\nstring text\n"},
};

/// Converts "sensor_msgs/msg/Imu" to "sensor_msgs/Imu"; empty if the text is not a ROS 2 type name.
std::string short_type(const std::string& type) {
  const std::size_t middle = type.find("/msg/");
  return middle == std::string::npos ? "" : type.substr(0, middle) + type.substr(middle + 4);
}

/// Returns the fields of a type of the table or of a sensor; empty if the type is unknown.
std::string_view fields_of(std::string_view type) {
  for (const Definition& definition : kDefinitions) {
    if (definition.type == type) return definition.fields;
  }
  std::string_view fields;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if (fields.empty() && short_type(kRosType<Message>) == type) fields = ros_message_fields<Message>();
  });
  return fields;
}

/// Converts "sensor_msgs/Imu[]" to "sensor_msgs/Imu"; empty for primitives.
std::string used_type(const std::string& field_type) {
  const std::string type = field_type.substr(0, field_type.find('['));
  return type.find('/') == std::string::npos ? "" : type;
}

void append_used(const std::string& type, std::set<std::string>& done, std::string& text) {
  std::istringstream lines{std::string(fields_of(type))};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    const std::string used = used_type(line.substr(0, line.find(' ')));
    if (used.empty() || !done.insert(used).second) continue;
    text += fmt::format("{:=<80}\nMSG: {}\n{}", "", used, fields_of(used));
    append_used(used, done, text);
  }
}

}  // namespace

std::string ros_definition(const std::string& type) {
  const std::string short_name = short_type(type);
  if (short_name.empty()) throw std::logic_error("not a ROS 2 type name: " + type);
  std::string text(fields_of(short_name));
  if (text.empty()) throw std::logic_error("no definition of " + type);
  std::set<std::string> done;
  append_used(short_name, done, text);
  return text;
}

}  // namespace patrol::io
