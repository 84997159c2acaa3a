#pragma once

#include <type_traits>
#include <vector>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "io/ros/ros_messages.h"

namespace patrol::io {

/// Topic of a log.
struct TopicInfo {
  const char* topic = nullptr;
  const char* type = nullptr;     ///< ROS message type
  const char* source = nullptr;   ///< writer: "sensor", "stack" or "ground truth"
  const char* summary = nullptr;  ///< line of documentation in `patrol list`
};

/// Entry of a message in the table of topics; empty for messages that are not logged.
template <typename Message>
inline constexpr TopicInfo kTopicInfo{};

template <IsSensorMessage Message>
inline constexpr TopicInfo kTopicInfo<Message>{SensorTraits<Message>::kInfo.topic,
                                               SensorTraits<Message>::kInfo.ros_type, "sensor",
                                               SensorTraits<Message>::kInfo.summary};

/// Entry of a message of the stack.
template <typename Message>
constexpr TopicInfo stack_topic(const char* topic, const char* summary) {
  return {topic, kRosType<Message>, "stack", summary};
}
/// Entry of a message that the simulator writes to the log and that the stack never gets.
template <typename Message>
constexpr TopicInfo truth_topic(const char* topic, const char* summary) {
  return {topic, kRosType<Message>, "ground truth", summary};
}

template <>
inline constexpr TopicInfo kTopicInfo<ScanCommand> = stack_topic<ScanCommand>("/scanner/command",
                                                                              "Request for one panoramic scan");
template <>
inline constexpr TopicInfo kTopicInfo<AntennaCommand> =
    stack_topic<AntennaCommand>("/tem/antenna_command", "Target direction of the sounding antenna");
template <>
inline constexpr TopicInfo kTopicInfo<SoundingCommand> =
    stack_topic<SoundingCommand>("/tem/command", "Request for one electromagnetic sounding");
template <>
inline constexpr TopicInfo kTopicInfo<WarningCommand> =
    stack_topic<WarningCommand>("/warning", "State of the warning light and the siren");
template <>
inline constexpr TopicInfo kTopicInfo<LiningResult> = stack_topic<LiningResult>("/inspection/lining",
                                                                                "Lining deformation around a station");
template <>
inline constexpr TopicInfo kTopicInfo<WaterResult> = stack_topic<WaterResult>("/inspection/water",
                                                                              "Water ahead of the tunnel face");
template <>
inline constexpr TopicInfo kTopicInfo<LocalizationConfidence> = stack_topic<LocalizationConfidence>(
    "/localization_confidence", "Confidence of the localization, and whether it is lost");
template <>
inline constexpr TopicInfo kTopicInfo<CalibrationEstimate> = stack_topic<CalibrationEstimate>(
    "/calibration", "Estimates of all calibration parameters with standard deviations");
template <>
inline constexpr TopicInfo kTopicInfo<OdometryEstimate> =
    stack_topic<OdometryEstimate>("/odom", "Pose of the body in odom, by odometry");
template <>
inline constexpr TopicInfo kTopicInfo<PoseEstimate> =
    stack_topic<PoseEstimate>("/pose", "Pose of the level body in map, with covariance");
template <>
inline constexpr TopicInfo kTopicInfo<UwbPoseEstimate> =
    stack_topic<UwbPoseEstimate>("/uwb_odometry/pose", "Pose by odometry and UWB ranges alone, without lidar");
template <>
inline constexpr TopicInfo kTopicInfo<SiteRegistration> =
    stack_topic<SiteRegistration>("/site_registration", "Estimated pose of map in the survey frame");
template <>
inline constexpr TopicInfo kTopicInfo<ParticleSet> =
    stack_topic<ParticleSet>("/particles", "Weighted particles of Monte Carlo localization");
template <>
inline constexpr TopicInfo kTopicInfo<MapUpdate> = stack_topic<MapUpdate>("/map", "Occupancy grid of the built map");
template <>
inline constexpr TopicInfo kTopicInfo<Path> = stack_topic<Path>("/plan", "Planned path to the goal");
template <>
inline constexpr TopicInfo kTopicInfo<VelocityCommand> =
    stack_topic<VelocityCommand>("/cmd_vel", "Velocity command to the locomotion");
template <>
inline constexpr TopicInfo kTopicInfo<Event> = stack_topic<Event>("/events",
                                                                  "Events, such as alarms and reached stations");
template <>
inline constexpr TopicInfo kTopicInfo<GroundTruth> = truth_topic<GroundTruth>("/ground_truth/odom",
                                                                              "True pose and velocity of the body");
template <>
inline constexpr TopicInfo kTopicInfo<SimState> = truth_topic<SimState>("/sim/state",
                                                                        "State of the physics model, for the replay");
template <>
inline constexpr TopicInfo kTopicInfo<AsBuiltTruth> =
    truth_topic<AsBuiltTruth>("/ground_truth/as_built", "Calibration and manufacturing errors drawn for this robot");
template <>
inline constexpr TopicInfo kTopicInfo<Collision> = truth_topic<Collision>("/ground_truth/collisions",
                                                                          "Unintended contacts of the robot");

/// Transforms between the frames of the estimates; TransformSet is written to two topics.
inline constexpr TopicInfo kTransforms =
    stack_topic<TransformSet>("/tf", "Transforms of the estimates: map, odom, base_footprint, base_link");
inline constexpr TopicInfo kStaticTransforms =
    stack_topic<TransformSet>("/tf_static", "Transforms from the body to the sensor frames, by the robot's model");

/// Topic of a message.
template <typename Message>
inline constexpr const char* kTopic = kTopicInfo<Message>.topic;

/// Every topic that a log can have: sensors, stack, ground truth.
std::vector<TopicInfo> topic_infos();

}  // namespace patrol::io
