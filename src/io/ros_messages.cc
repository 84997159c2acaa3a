#include "io/ros_messages.h"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include "core/error.h"

namespace patrol::io {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

/// One description of a message's fields serves both ways: `codec(field)` writes the field or fills it.
struct Writer {
  Cdr& cdr;
  const RosNames& names;
  static constexpr bool kWrites = true;
  template <typename T>
  void operator()(T& value) { cdr << value; }
};

struct Reader {
  Cdr& cdr;
  RosNames names{};
  static constexpr bool kWrites = false;
  template <typename T>
  void operator()(T& value) { cdr >> value; }
};

template <typename Codec>
void time_field(Codec& codec, Time& time) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  auto seconds = static_cast<std::int32_t>(time.count() / kSecond);
  auto nanoseconds = static_cast<std::uint32_t>(time.count() % kSecond);
  codec(seconds);
  codec(nanoseconds);
  time = Time{seconds * kSecond + nanoseconds};
}

template <typename Codec>
void header(Codec& codec, Time& stamp, std::string frame) {
  time_field(codec, stamp);
  codec(frame);
}

/// A double of ours that is a float32 in ROS.
template <typename Codec>
void float_field(Codec& codec, double& value) {
  auto single = static_cast<float>(value);
  codec(single);
  if constexpr (!Codec::kWrites) value = single;
}

template <typename Codec>
void vector3(Codec& codec, Eigen::Vector3d& v) {
  codec(v.x());
  codec(v.y());
  codec(v.z());
}

template <typename Codec>
void pose3(Codec& codec, Pose3& pose) {
  vector3(codec, pose.position);
  codec(pose.rotation.x());
  codec(pose.rotation.y());
  codec(pose.rotation.z());
  codec(pose.rotation.w());
}

template <typename Codec>
void pose2(Codec& codec, Pose2& pose) {
  Pose3 spatial = to_spatial(pose);
  pose3(codec, spatial);
  if constexpr (!Codec::kWrites) pose = to_planar(spatial);
}

/// The covariance of x, y, yaw inside ROS's 6 x 6 of x, y, z, roll, pitch, yaw.
template <typename Codec>
void planar_covariance(Codec& codec, Eigen::Matrix3d& covariance) {
  constexpr std::array<std::size_t, 3> kRows = {0, 1, 5};
  std::array<double, 36> full{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) full[6 * kRows[static_cast<std::size_t>(i)] + kRows[static_cast<std::size_t>(j)]] = covariance(i, j);
  }
  codec(full);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) covariance(i, j) = full[6 * kRows[static_cast<std::size_t>(i)] + kRows[static_cast<std::size_t>(j)]];
  }
}

template <typename Codec>
void twist3(Codec& codec, Twist3& twist) {
  vector3(codec, twist.linear);
  vector3(codec, twist.angular);
}

/// ROS's variable-length lists of messages.
template <typename Codec, typename Element, typename Describe>
void list(Codec& codec, std::vector<Element>& elements, const Describe& describe) {
  auto count = static_cast<std::uint32_t>(elements.size());
  codec(count);
  if constexpr (!Codec::kWrites) elements.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if constexpr (!Codec::kWrites) elements.emplace_back();
    describe(elements[i]);
  }
}

template <typename Codec>
void describe(Codec& codec, LaserScan& scan) {
  header(codec, scan.stamp, "lidar");
  float_field(codec, scan.angle_min_rad);
  double angle_max_rad = scan.angle_min_rad + scan.angle_increment_rad * (static_cast<double>(scan.ranges_m.size()) - 1.0);
  float_field(codec, angle_max_rad);
  float_field(codec, scan.angle_increment_rad);
  float_field(codec, scan.time_increment_s);
  float_field(codec, scan.scan_time_s);
  float_field(codec, scan.range_min_m);
  float_field(codec, scan.range_max_m);
  codec(scan.ranges_m);
  codec(scan.intensities);
}

template <typename Codec>
void describe(Codec& codec, PointCloud& cloud) {
  header(codec, cloud.stamp, "lidar3d");
  // Packed as LIO-SAM has it: x y z intensity (float32), ring (uint16), time (float32).
  constexpr std::uint32_t kStep = 22;
  constexpr std::uint8_t kFloat32 = 7, kUint16 = 4;
  std::uint32_t height = 1, width = static_cast<std::uint32_t>(cloud.points.size());
  codec(height);
  codec(width);
  struct Field {
    std::string name;
    std::uint32_t offset = 0;
    std::uint8_t type = 0;
    std::uint32_t count = 1;
  };
  std::vector<Field> fields = {{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {"intensity", 12, kFloat32},
                               {"ring", 16, kUint16}, {"time", 18, kFloat32}};
  list(codec, fields, [&](Field& field) {
    codec(field.name);
    codec(field.offset);
    codec(field.type);
    codec(field.count);
  });
  bool is_big_endian = false, is_dense = true;
  std::uint32_t step = kStep, row_step = kStep * width;
  codec(is_big_endian);
  codec(step);
  codec(row_step);
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
  codec(is_dense);
  if constexpr (!Codec::kWrites) {
    if (step != kStep) throw DecodeError("a point cloud of another layout than ours");
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
  for (std::size_t i = 0; i < 3; ++i) covariance[4 * i] = fix.position_std_m[static_cast<int>(i)] * fix.position_std_m[static_cast<int>(i)];
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
      throw DecodeError("a range of a frame that is not ultrasonic_<number>");
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
    if (bytes.size() != std::size_t{2} * width * height) throw DecodeError("an image whose pixels do not fit its size");
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
void describe(Codec& codec, RemoteCommand& command) {
  header(codec, command.stamp, frame_id::kLevel);
  codec(command.vx_mps);
  codec(command.yaw_rate_radps);
  codec(command.mark);
  codec(command.hand_over);
}

template <typename Codec>
void describe(Codec& codec, LocalizationTrust& trust) {
  header(codec, trust.stamp, frame_id::kMap);
  codec(trust.trust);
  codec(trust.weak_std_m);
  codec(trust.weak_direction_rad);
  codec(trust.is_lost);
}

template <typename Codec>
void odometry_fields(Codec& codec, Time& stamp, const char* frame, Pose3& pose, Eigen::Matrix3d& covariance, Twist3& twist) {
  header(codec, stamp, frame);
  std::string child = frame_id::kBody;
  codec(child);
  pose3(codec, pose);
  planar_covariance(codec, covariance);
  twist3(codec, twist);
  std::array<double, 36> unstated{};
  codec(unstated);
}

template <typename Codec>
void describe(Codec& codec, OdometryEstimate& odometry) {
  odometry_fields(codec, odometry.stamp, frame_id::kOdom, odometry.T_odom_body, odometry.planar_covariance, odometry.twist);
}

template <typename Codec>
void describe(Codec& codec, GroundTruth& truth) {
  Eigen::Matrix3d exact = Eigen::Matrix3d::Zero();
  odometry_fields(codec, truth.stamp, frame_id::kWorld, truth.T_world_body, exact, truth.twist);
}

template <typename Codec>
void describe(Codec& codec, PoseEstimate& estimate) {
  header(codec, estimate.stamp, frame_id::kMap);
  pose2(codec, estimate.T_map_body);
  planar_covariance(codec, estimate.covariance);
}

template <typename Codec>
void describe(Codec& codec, ParticleSet& particles) {
  header(codec, particles.stamp, frame_id::kMap);
  struct Particle {
    Pose2 pose;
    double weight = 0.0;
  };
  std::vector<Particle> rows;
  for (std::size_t i = 0; i < particles.weights.size(); ++i) rows.push_back({particles.T_map_body[i], particles.weights[i]});
  list(codec, rows, [&](Particle& particle) {
    pose2(codec, particle.pose);
    codec(particle.weight);
  });
  if constexpr (!Codec::kWrites) {
    for (const Particle& particle : rows) {
      particles.T_map_body.push_back(particle.pose);
      particles.weights.push_back(particle.weight);
    }
  }
}

template <typename Codec>
void describe(Codec& codec, MapUpdate& update) {
  header(codec, update.stamp, frame_id::kMap);
  GridGeometry geometry = update.map.geometry();
  time_field(codec, update.stamp);
  float_field(codec, geometry.resolution_m);
  auto width = static_cast<std::uint32_t>(geometry.width), height = static_cast<std::uint32_t>(geometry.height);
  codec(width);
  codec(height);
  Pose3 origin{.position = {geometry.origin_m.x(), geometry.origin_m.y(), 0.0}};
  pose3(codec, origin);
  std::vector<std::int8_t> cells = update.map.values();
  codec(cells);
  if constexpr (!Codec::kWrites) {
    // A float32 cannot hold 0.05: back to the tenth of a millimetre that was meant.
    geometry = {.resolution_m = std::round(geometry.resolution_m * 1e4) / 1e4, .width = static_cast<int>(width),
                .height = static_cast<int>(height), .origin_m = origin.position.head<2>()};
    if (cells.size() != geometry.size()) throw DecodeError("a map whose cells do not fit its size");
    update.map = OccupancyGrid(geometry);
    update.map.values() = std::move(cells);
  }
}

template <typename Codec>
void describe(Codec& codec, Path& path) {
  header(codec, path.stamp, frame_id::kMap);
  list(codec, path.T_map_body, [&](Pose2& pose) {
    header(codec, path.stamp, frame_id::kMap);
    pose2(codec, pose);
  });
}

template <typename Codec>
void describe(Codec& codec, VelocityCommand& command) {
  header(codec, command.stamp, frame_id::kLevel);
  Twist3 twist{.linear = {command.vx_mps, command.vy_mps, 0.0}, .angular = {0.0, 0.0, command.yaw_rate_radps}};
  twist3(codec, twist);
  command.vx_mps = twist.linear.x();
  command.vy_mps = twist.linear.y();
  command.yaw_rate_radps = twist.angular.z();
}

template <typename Codec>
void describe(Codec& codec, Event& event) {
  header(codec, event.stamp, frame_id::kMap);
  codec(event.kind);
  codec(event.subject);
  codec(event.text);
  codec(event.value);
  pose2(codec, event.T_map_body);
  double height_m = 0.0;
  codec(event.p_map_target.x());
  codec(event.p_map_target.y());
  codec(height_m);
}

template <typename Codec>
void describe(Codec& codec, SimState& state) {
  header(codec, state.stamp, frame_id::kWorld);
  codec(state.qpos);
  codec(state.mocap);
}

template <typename Codec>
void describe(Codec& codec, Collision& collision) {
  header(codec, collision.stamp, frame_id::kWorld);
  codec(collision.first);
  codec(collision.second);
}

template <typename Codec>
void describe(Codec& codec, TransformSet& set) {
  list(codec, set.transforms, [&](FrameTransform& transform) {
    time_field(codec, transform.stamp);
    codec(transform.parent);
    codec(transform.child);
    pose3(codec, transform.T_parent_child);
  });
}

void read_head(Reader& reader, std::string& frame) {
  Time stamp{};
  time_field(reader, stamp);
  reader(frame);
}

/// Hands the bytes to `read`. Throws DecodeError "not a <type>: ...".
template <typename Read>
void read_cdr(std::string_view bytes, const char* type, const Read& read) {
  try {
    FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());  // only read from
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    Reader reader{cdr};
    read(reader);
  } catch (const eprosima::fastcdr::exception::Exception& error) {
    throw DecodeError(std::string("not a ") + type + ": " + error.what());
  }
}

/// Returns how many bytes it has written.
template <typename Message>
std::size_t serialize(Message& message, const RosNames& names, FastBuffer& buffer) {
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  Writer writer{cdr, names};
  describe(writer, message);
  return cdr.getSerializedDataLength();
}

}  // namespace

// Twice: Fast-CDR leaves its padding as it finds it, so the bytes must be zero before, and to that end be counted.
template <typename Message>
std::string encode(const Message& message, const RosNames& names) {
  Message copy = message;
  FastBuffer counted;
  std::string bytes(serialize(copy, names, counted), '\0');
  FastBuffer buffer(bytes.data(), bytes.size());
  serialize(copy, names, buffer);
  return bytes;
}

template <typename Message>
Message decode(std::string_view bytes) {
  Message message;
  read_cdr(bytes, kRosType<Message>, [&](Reader& reader) { describe(reader, message); });
  return message;
}

OdometryFrames odometry_frames_of(std::string_view bytes) {
  OdometryFrames frames;
  read_cdr(bytes, kRosType<OdometryEstimate>, [&](Reader& reader) {
    read_head(reader, frames.frame);
    reader(frames.child);
  });
  return frames;
}

std::string frame_id_of(std::string_view bytes) {
  std::string frame;
  read_cdr(bytes, "message with a header", [&](Reader& reader) { read_head(reader, frame); });
  return frame;
}

#define PATROL_ROS_MESSAGE(Message)                                     \
  template std::string encode(const Message&, const RosNames&);         \
  template Message decode<Message>(std::string_view)
PATROL_ROS_MESSAGE(LaserScan);
PATROL_ROS_MESSAGE(PointCloud);
PATROL_ROS_MESSAGE(Imu);
PATROL_ROS_MESSAGE(JointState);
PATROL_ROS_MESSAGE(FootContacts);
PATROL_ROS_MESSAGE(GasReading);
PATROL_ROS_MESSAGE(GnssFix);
PATROL_ROS_MESSAGE(TrackTicks);
PATROL_ROS_MESSAGE(UwbRange);
PATROL_ROS_MESSAGE(UltrasonicRange);
PATROL_ROS_MESSAGE(DepthImage);
PATROL_ROS_MESSAGE(RemoteCommand);
PATROL_ROS_MESSAGE(LocalizationTrust);
PATROL_ROS_MESSAGE(OdometryEstimate);
PATROL_ROS_MESSAGE(PoseEstimate);
PATROL_ROS_MESSAGE(RangePoseEstimate);
PATROL_ROS_MESSAGE(ParticleSet);
PATROL_ROS_MESSAGE(MapUpdate);
PATROL_ROS_MESSAGE(Path);
PATROL_ROS_MESSAGE(VelocityCommand);
PATROL_ROS_MESSAGE(Event);
PATROL_ROS_MESSAGE(GroundTruth);
PATROL_ROS_MESSAGE(SimState);
PATROL_ROS_MESSAGE(Collision);
PATROL_ROS_MESSAGE(TransformSet);
#undef PATROL_ROS_MESSAGE

}  // namespace patrol::io
