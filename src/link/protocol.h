#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"
#include "io/ros/ros_messages.h"

/// Turn protocol between the simulator and a stack in another process (README.md).
namespace patrol::link {

/// Version of the protocol. Programs of different versions refuse each other.
inline constexpr std::uint32_t kProtocolVersion = 1;

/// Limits of the robot's base, in level, by its data sheet. Faster commands are limited.
struct VelocityLimits {
  double forward_mps = 0.0;
  double backward_mps = 0.0;
  double sideways_mps = 0.0;  ///< 0: the base does not move sideways
  double yaw_rate_radps = 0.0;
};

/// First message of the simulator: the run, and the documents of the robot and the site. None of them depends on the
/// values that were drawn for the simulated robot. A recorded log has neither robot nor site: both are empty.
struct Hello {
  std::uint32_t protocol = kProtocolVersion;
  std::string program;   ///< name and version, e.g. "patrol 0.2.0"
  std::string scenario;  ///< name of the scenario
  std::uint64_t seed = 0;
  Time tick{};  ///< physics tick; turns are at multiples of it
  VelocityLimits limits = {};
  std::string robot;              ///< URDF of the robot
  std::string site;               ///< survey of the site and stations of the mission (io/json/route_json.h), JSON
  std::string goals = {};         ///< saved goals in map (io/json/nav_json.h), JSON; empty: none are given
  std::string registration = {};  ///< pose of a known map in site (io/json/registration_json.h), JSON; empty: the map's
                                  ///< origin is the surveyed start
  std::string documents;          ///< settings that the stack may know, YAML with the keys of a scenario
};

/// Answer of the stack to the hello.
struct HelloReply {
  std::uint32_t protocol = kProtocolVersion;
  std::string stack;                ///< name of the stack, for reports
  std::vector<std::string> topics;  ///< topics to send; empty: all
  Time turn_period{};               ///< time from one turn to the next where `done` names none; 0: one tick
};

/// Turn of the stack, after all messages that are due up to `now`.
struct Turn {
  Time now{};
  bool is_last = false;  ///< the run ends: publish final results
};

/// End of a turn, after all messages that the stack publishes in it.
struct Done {
  Time now{};        ///< time of the turn
  Time next_turn{};  ///< time of the next turn, after `now`; 0: by the turn period
  bool mission_is_over = false;
};

/// Last message of a side that ends the connection because of an error.
struct Failure {
  std::string text;
};

/// Topic of the map that the robot is given before the start, as it localizes itself on a known map.
inline constexpr const char* kSiteMapTopic = "/site_map";

/// Topics of the protocol itself.
template <typename Message>
inline constexpr const char* kControlTopic = nullptr;
template <>
inline constexpr const char* kControlTopic<Hello> = "/link/hello";
template <>
inline constexpr const char* kControlTopic<HelloReply> = "/link/hello_reply";
template <>
inline constexpr const char* kControlTopic<Turn> = "/link/turn";
template <>
inline constexpr const char* kControlTopic<Done> = "/link/done";
template <>
inline constexpr const char* kControlTopic<Failure> = "/link/failure";

}  // namespace patrol::link

namespace patrol::io {

template <>
inline constexpr const char* kRosType<link::Hello> = "patrol_msgs/msg/LinkHello";
template <>
inline constexpr const char* kRosType<link::HelloReply> = "patrol_msgs/msg/LinkHelloReply";
template <>
inline constexpr const char* kRosType<link::Turn> = "patrol_msgs/msg/LinkTurn";
template <>
inline constexpr const char* kRosType<link::Done> = "patrol_msgs/msg/LinkDone";
template <>
inline constexpr const char* kRosType<link::Failure> = "patrol_msgs/msg/LinkFailure";

}  // namespace patrol::io
