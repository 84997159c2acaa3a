#include <unistd.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "io/urdf.h"
#include "link/stack_client.h"
#include "mrpt_stack.h"

namespace mrpt_stack {
namespace {

using patrol::link::StackClient;

constexpr Time kPeriod = std::chrono::milliseconds(100);
constexpr Time kSettling = std::chrono::seconds(4);  ///< standing time for the bias of the gyro

Pose2 pose_of(const nlohmann::json& json) {
  const auto& p = json.at("position");
  const auto& q = json.at("orientation");
  return {p.at(0).get<double>(), p.at(1).get<double>(), 2.0 * std::atan2(q.at(2).get<double>(), q.at(3).get<double>())};
}

patrol::RobotDescription robot_of(const std::string& urdf) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("mrpt_stack_" + std::to_string(::getpid()) + ".urdf");
  std::ofstream(file) << urdf;
  patrol::RobotDescription robot = patrol::io::load_robot_description(file.string());
  std::filesystem::remove(file);
  return robot;
}

std::string document(const StackClient& client, const std::string& topic) {
  for (const patrol::link::DeliveredMessage& message : client.documents()) {
    if (message.topic == topic) return message.cdr;
  }
  throw std::runtime_error("the scenario gives no " + topic);
}

/// The robot's software, from the documents of the hello to the end of the run.
void run() {
  StackClient client = StackClient::connect();
  const patrol::link::Hello& hello = client.hello();
  const patrol::RobotDescription robot = robot_of(hello.robot);
  if (!robot.tracks) throw std::runtime_error("the robot has no tracks");
  const YAML::Node settings = YAML::Load(hello.documents);
  const double ticks_per_turn = settings["stack"]["odometry"]["tracked"]["ticks_per_sprocket_turn"].as<double>();
  const nlohmann::json site = nlohmann::json::parse(hello.site);
  const Pose2 T_site_start = pose_of(site.at("start"));
  const Pose2 T_site_map =
      hello.registration.empty() ? T_site_start : pose_of(nlohmann::json::parse(hello.registration));
  std::vector<Pose2> goals;
  for (const nlohmann::json& goal : nlohmann::json::parse(hello.goals)) goals.push_back(pose_of(goal));

  TrackOdometry odometry(2.0 * std::numbers::pi * robot.tracks->sprocket_radius_m / ticks_per_turn);
  const patrol::Pose3 T_body_lidar = robot.T_body("lidar");
  Localization localization(patrol::io::decode<patrol::MapUpdate>(document(client, patrol::link::kSiteMapTopic)).map,
                            T_site_map.inverse() * T_site_start, T_body_lidar, hello.seed);
  LowObstacles low_obstacles(robot.T_body("depth_camera"), -robot.tracks->body_height_m);
  Navigation navigation(robot.footprint_m, goals);
  client.begin("mrpt",
               {patrol::io::kTopic<patrol::LaserScan>, patrol::io::kTopic<patrol::Imu>,
                patrol::io::kTopic<patrol::TrackTicks>, patrol::io::kTopic<patrol::DepthImage>},
               kPeriod);
  std::size_t num_reported = 0;
  while (true) {
    const patrol::link::ReceivedTurn turn = client.next_turn();
    std::optional<patrol::LaserScan> scan;
    for (const patrol::link::DeliveredMessage& message : turn.messages) {
      if (message.topic == patrol::io::kTopic<patrol::Imu>) {
        odometry.add(patrol::io::decode<patrol::Imu>(message.cdr));
      } else if (message.topic == patrol::io::kTopic<patrol::TrackTicks>) {
        odometry.add(patrol::io::decode<patrol::TrackTicks>(message.cdr));
      } else if (message.topic == patrol::io::kTopic<patrol::DepthImage>) {
        low_obstacles.add(patrol::io::decode<patrol::DepthImage>(message.cdr), odometry.pose());
      } else {
        scan = patrol::io::decode<patrol::LaserScan>(message.cdr);
        localization.update(*scan, odometry.pose());
      }
    }
    const Pose2 T_map_body = localization.pose_at(odometry.pose());
    client.publish(turn.now, patrol::PoseEstimate{turn.now, T_map_body, localization.covariance()});
    client.publish(turn.now, patrol::OdometryEstimate{.stamp = turn.now,
                                                      .T_odom_body = to_pose3(odometry.pose()),
                                                      .twist = {.linear = {odometry.speed_mps(), 0.0, 0.0},
                                                                .angular = {0.0, 0.0, odometry.yaw_rate_radps()}}});
    if (turn.now >= kSettling && !turn.is_last) {
      client.publish(turn.now, navigation.step(turn.now, localization, odometry, scan, T_body_lidar, low_obstacles));
      client.publish(turn.now, patrol::Path{turn.now, navigation.path()});
    }
    for (; num_reported < navigation.num_reached(); ++num_reported) {
      client.publish(turn.now, patrol::Event{.stamp = turn.now,
                                             .kind = patrol::EventKind::kGoalReached,
                                             .subject = "goal_" + std::to_string(num_reported + 1),
                                             .text = "Goal reached.",
                                             .value = 1.0,
                                             .T_map_body = T_map_body,
                                             .p_map_target = T_map_body.position()});
      if (navigation.is_over() && num_reported + 1 == goals.size()) {
        client.publish(turn.now, patrol::Event{.stamp = turn.now,
                                               .kind = patrol::EventKind::kMissionCompleted,
                                               .subject = "",
                                               .text = "All goals reached.",
                                               .value = 0.0,
                                               .T_map_body = T_map_body,
                                               .p_map_target = T_map_body.position()});
      }
    }
    client.done({.now = turn.now, .next_turn = {}, .mission_is_over = navigation.is_over()});
    if (turn.is_last) return;
  }
}

}  // namespace
}  // namespace mrpt_stack

int main() {
  try {
    mrpt_stack::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mrpt_stack: %s\n", error.what());
    return 1;
  }
  return 0;
}
