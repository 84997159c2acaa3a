#pragma once

#include <optional>
#include <string_view>
#include <tuple>
#include <variant>
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
  const char* source = nullptr;   ///< writer: "sensor", "firmware", "stack", "simulator" or "ground truth"
  const char* summary = nullptr;  ///< line of documentation in `patrol list`
};

/// Row of the table of topics: the topic of a message.
template <typename Message>
struct TopicOf : TopicInfo {};

/// Row of a message of the stack.
template <typename Message>
constexpr TopicOf<Message> stack_topic(const char* topic, const char* summary) {
  return {{topic, kRosType<Message>, "stack", summary}};
}
/// Row of a message of the robot's firmware to the stack.
template <typename Message>
constexpr TopicOf<Message> firmware_topic(const char* topic, const char* summary) {
  return {{topic, kRosType<Message>, "firmware", summary}};
}
/// Row of a record of the simulator about the run.
template <typename Message>
constexpr TopicOf<Message> simulator_topic(const char* topic, const char* summary) {
  return {{topic, kRosType<Message>, "simulator", summary}};
}
/// Row of a message that the simulator writes to the log and that the stack never gets.
template <typename Message>
constexpr TopicOf<Message> truth_topic(const char* topic, const char* summary) {
  return {{topic, kRosType<Message>, "ground truth", summary}};
}

/// Table of the topics of all logged messages but the sensors', whose traits contain the topic.
inline constexpr std::tuple kTopicTable{
    stack_topic<OdometryEstimate>("/odom", "Pose of the body in odom, by odometry"),
    stack_topic<PoseEstimate>("/pose", "Pose of the level body in map, with covariance"),
    stack_topic<UwbPoseEstimate>("/uwb_odometry/pose", "Pose by odometry and UWB ranges alone, without lidar"),
    stack_topic<SiteRegistration>("/site_registration", "Estimated pose of map in the survey frame"),
    stack_topic<CalibrationEstimate>("/calibration",
                                     "Estimates of all calibration parameters with standard deviations"),
    stack_topic<LocalizationConfidence>("/localization_confidence",
                                        "Confidence of the localization, and whether it is lost"),
    stack_topic<ParticleSet>("/particles", "Weighted particles of Monte Carlo localization"),
    stack_topic<MapUpdate>("/map", "Occupancy grid of the built map"),
    stack_topic<Path>("/plan", "Planned path to the goal"),
    stack_topic<TrajectoryEstimate>("/trajectory", "Path of the robot with all corrections of a SLAM method up to now"),
    stack_topic<VelocityCommand>("/cmd_vel", "Velocity command to the locomotion"),
    stack_topic<ScanCommand>("/scanner/command", "Request for one panoramic scan"),
    stack_topic<AntennaCommand>("/tem/antenna_command", "Target direction of the sounding antenna"),
    stack_topic<SoundingCommand>("/tem/command", "Request for one electromagnetic sounding"),
    stack_topic<WarningCommand>("/warning", "State of the warning light and the siren"),
    stack_topic<LiningResult>("/inspection/lining", "Lining deformation around a station"),
    stack_topic<WaterResult>("/inspection/water", "Water ahead of the tunnel face"),
    stack_topic<Event>("/events", "Events, such as alarms and reached stations"),
    firmware_topic<FallReport>("/fall", "Report of the firmware that the robot has fallen"),
    firmware_topic<RecordedOdometry>("/recorded_odometry", "Odometry of a recorded log that `patrol feed` reads"),
    simulator_topic<StackTurnRecord>("/stack/turns", "Turns of a stack in another process, or with a computing time"),
    truth_topic<GroundTruth>("/ground_truth/odom", "True pose and velocity of the body"),
    truth_topic<SimState>("/sim/state", "State of the physics model, for the replay"),
    truth_topic<AsBuiltTruth>("/ground_truth/as_built", "Calibration and manufacturing errors drawn for this robot"),
    truth_topic<Collision>("/ground_truth/collisions", "Unintended contacts of the robot")};

/// Transforms between the frames of the estimates, which Patrol derives from the messages of the stack. TransformSet is
/// written to two topics.
inline constexpr TopicInfo kTransforms =
    simulator_topic<TransformSet>("/tf", "Transforms of the estimates: map, odom, base_footprint, base_link");
inline constexpr TopicInfo kStaticTransforms =
    simulator_topic<TransformSet>("/tf_static", "Transforms from the body to the sensor frames, by the robot's model");

/// Entry of a logged message.
template <typename Message>
constexpr TopicInfo topic_info() {
  if constexpr (IsSensorMessage<Message>) {
    constexpr auto& kInfo = SensorTraits<Message>::kInfo;
    return {kInfo.topic, kInfo.ros_type, "sensor", kInfo.summary};
  } else {
    return std::get<TopicOf<Message>>(kTopicTable);
  }
}

/// Topic of a message.
template <typename Message>
inline constexpr const char* kTopic = topic_info<Message>().topic;

/// Decodes a message of a topic into the alternative of a variant that has this topic; nullopt if there is none. Throws
/// DecodeError.
template <typename Variant, std::size_t kIndex = 0>
std::optional<Variant> decode_as(std::string_view topic, std::string_view cdr) {
  if constexpr (kIndex == std::variant_size_v<Variant>) return std::nullopt;
  else {
    using Message = std::variant_alternative_t<kIndex, Variant>;
    if (topic == kTopic<Message>) return Variant(decode<Message>(cdr));
    return decode_as<Variant, kIndex + 1>(topic, cdr);
  }
}

/// Every topic that a log can have: sensors, firmware, stack, simulator, ground truth.
std::vector<TopicInfo> topic_infos();
/// Returns the entry of a topic; nullopt for one that the program does not know.
std::optional<TopicInfo> find_topic(std::string_view topic);

/// Returns whether the stack receives a topic: one of a sensor or of the firmware.
bool is_stack_input(std::string_view topic);
/// Returns whether the stack publishes a topic. One that the program does not know is a stack's.
bool is_stack_output(std::string_view topic);

}  // namespace patrol::io
