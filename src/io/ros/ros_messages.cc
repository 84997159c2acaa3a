// Codecs of the messages of the stack and of the ground truth, and readers of single fields of a message.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, LocalizationConfidence& confidence) {
  header(codec, confidence.stamp, frame_id::kMap);
  codec(confidence.confidence);
  codec(confidence.max_std_m);
  codec(confidence.max_std_direction_rad);
  codec(confidence.is_lost);
}

template <typename Codec>
void describe(Codec& codec, CalibrationEstimate& estimate) {
  header(codec, estimate.stamp, frame_id::kBody);
  list(codec, estimate.values, [&](CalibrationValue& value) {
    codec(value.name);
    codec(value.value);
    codec(value.std);
  });
}

template <typename Codec>
void odometry_fields(Codec& codec, Time& stamp, const char* frame, Pose3& pose, Eigen::Matrix3d& covariance,
                     Twist3& twist) {
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
  odometry_fields(codec, odometry.stamp, frame_id::kOdom, odometry.T_odom_body, odometry.planar_covariance,
                  odometry.twist);
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
void describe(Codec& codec, SiteRegistration& registration) {
  header(codec, registration.stamp, frame_id::kSite);
  pose2(codec, registration.T_site_map);
  planar_covariance(codec, registration.covariance);
}

template <typename Codec>
void describe(Codec& codec, ParticleSet& particles) {
  header(codec, particles.stamp, frame_id::kMap);
  struct Particle {
    Pose2 pose;
    double weight = 0.0;
  };
  std::vector<Particle> rows;
  for (std::size_t i = 0; i < particles.weights.size(); ++i)
    rows.push_back({particles.T_map_body[i], particles.weights[i]});
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

/// Returns the decimal with the fewest digits that a float32 represents: 0.05 for the float32 next to it.
inline double shortest_decimal(float value) {
  std::array<char, 64> digits{};
  const std::to_chars_result written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  double decimal = value;
  std::from_chars(digits.data(), written.ptr, decimal);
  return decimal;
}

/// Throws DecodeError if a grid is too far from the origin of its frame to compute with its cells.
inline void check_extent(const GridGeometry& geometry) {
  constexpr double kMaxCells = 1e9, kMinResolution_m = 1e-4;  // an index of a cell is an int
  const double limit_m = std::min(kMaxCoordinate_m, kMaxCells * std::max(geometry.resolution_m, kMinResolution_m));
  const Eigen::Vector2d size_m = geometry.resolution_m * Eigen::Vector2d(geometry.width, geometry.height);
  for (const Eigen::Vector2d& corner_m : {geometry.origin_m, Eigen::Vector2d(geometry.origin_m + size_m)}) {
    if (corner_m.cwiseAbs().maxCoeff() > limit_m) {
      throw DecodeError(fmt::format("map reaches to ({:g}, {:g}) m: must be within {:.0f} m of the origin of its frame",
                                    corner_m.x(), corner_m.y(), limit_m));
    }
  }
}

inline bool is_identity(const Eigen::Quaterniond& rotation) {
  constexpr double kTolerance = 1e-4;  // 1 cm at 50 m
  return rotation.vec().norm() <= kTolerance && std::abs(std::abs(rotation.w()) - 1.0) <= kTolerance;
}

template <typename Codec>
void describe(Codec& codec, MapUpdate& update) {
  header(codec, update.stamp, frame_id::kMap);
  GridGeometry geometry = update.map.geometry();
  Time map_load_time = update.stamp;
  time_field(codec, map_load_time);
  float_field(codec, geometry.resolution_m);
  auto width = static_cast<std::uint32_t>(geometry.width), height = static_cast<std::uint32_t>(geometry.height);
  codec(width);
  codec(height);
  Pose3 origin{.position = {geometry.origin_m.x(), geometry.origin_m.y(), 0.0}};
  pose3(codec, origin);
  std::vector<std::int8_t> cells = update.map.values();
  codec(cells);
  if constexpr (!Codec::kWrites) {
    if (!is_identity(origin.rotation)) {
      throw DecodeError(
          "orientation of the origin must be the identity (x, y, z = 0, w = 1): rotated maps are not "
          "supported");
    }
    geometry = {.resolution_m = shortest_decimal(static_cast<float>(geometry.resolution_m)),
                .width = static_cast<int>(width),
                .height = static_cast<int>(height),
                .origin_m = origin.position.head<2>()};
    check_extent(geometry);
    if (cells.size() != geometry.size()) throw DecodeError("number of map cells does not match its size");
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
void describe(Codec& codec, TrajectoryEstimate& estimate) {
  header(codec, estimate.stamp, frame_id::kMap);
  list(codec, estimate.T_map_body, [&](StampedPose& stamped) {
    header(codec, stamped.stamp, frame_id::kMap);
    pose3(codec, stamped.pose);
  });
}

template <typename Codec>
void describe(Codec& codec, RecordedOdometry& odometry) {
  Pose3 pose = to_pose3(odometry.T_odom_body);
  Eigen::Matrix3d unstated = Eigen::Matrix3d::Zero();
  Twist3 twist;
  odometry_fields(codec, odometry.stamp, frame_id::kOdom, pose, unstated, twist);
  odometry.T_odom_body = to_pose2(pose);
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
  std::string kind = kind_text(event);
  codec(kind);
  if constexpr (!Codec::kWrites) set_kind(event, kind);
  codec(event.subject);
  codec(event.text);
  codec(event.value);
  pose2(codec, event.T_map_body);
  double height_m = 0.0;
  mark_position(codec, {event.p_map_target.x(), event.p_map_target.y(), 0.0});
  codec(event.p_map_target.x());
  codec(event.p_map_target.y());
  codec(height_m);
}

template <typename Codec>
void describe(Codec& codec, FallReport& report) {
  header(codec, report.stamp, frame_id::kBody);
}

template <typename Codec>
void describe(Codec& codec, StackTurnRecord& record) {
  time_field(codec, record.turn);
  time_field(codec, record.delay);
  time_field(codec, record.next_turn);
  codec(record.is_last);
  codec(record.mission_is_over);
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
void describe(Codec& codec, AsBuiltTruth& truth) {
  header(codec, truth.stamp, frame_id::kBody);
  list(codec, truth.values, [&](std::pair<std::string, double>& value) {
    codec(value.first);
    codec(value.second);
  });
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

}  // namespace patrol::io::ros

namespace patrol::io {

OdometryFrames odometry_frames_of(std::string_view bytes) {
  OdometryFrames frames;
  ros::read_cdr(bytes, kRosType<OdometryEstimate>, [&](ros::Reader& reader) {
    ros::read_head(reader, frames.frame);
    reader(frames.child);
  });
  return frames;
}

MessageHeader header_of(std::string_view bytes) {
  MessageHeader header;
  ros::read_cdr(bytes, "message with a header", [&](ros::Reader& reader) {
    reader(header.seconds);
    reader(header.nanoseconds);
    reader(header.frame);
  });
  return header;
}

PATROL_ROS_MESSAGE(LocalizationConfidence);
PATROL_ROS_MESSAGE(CalibrationEstimate);
PATROL_ROS_MESSAGE(OdometryEstimate);
PATROL_ROS_MESSAGE(PoseEstimate);
PATROL_ROS_MESSAGE(UwbPoseEstimate);
PATROL_ROS_MESSAGE(SiteRegistration);
PATROL_ROS_MESSAGE(ParticleSet);
PATROL_ROS_MESSAGE(MapUpdate);
PATROL_ROS_MESSAGE(Path);
PATROL_ROS_MESSAGE(TrajectoryEstimate);
PATROL_ROS_MESSAGE(RecordedOdometry);
PATROL_ROS_MESSAGE(VelocityCommand);
PATROL_ROS_MESSAGE(Event);
PATROL_ROS_MESSAGE(FallReport);
PATROL_ROS_MESSAGE(StackTurnRecord);
PATROL_ROS_MESSAGE(GroundTruth);
PATROL_ROS_MESSAGE(SimState);
PATROL_ROS_MESSAGE(AsBuiltTruth);
PATROL_ROS_MESSAGE(Collision);
PATROL_ROS_MESSAGE(TransformSet);

}  // namespace patrol::io
