#include "hello.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "core/wheel_kinematics.h"
#include "io/urdf.h"

namespace mrpt_stack {
namespace {

using patrol::link::StackClient;

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

std::optional<patrol::OccupancyGrid> given_map(const StackClient& client) {
  for (const patrol::link::DeliveredMessage& message : client.documents()) {
    if (message.topic == patrol::link::kSiteMapTopic) return patrol::io::decode<patrol::MapUpdate>(message.cdr).map;
  }
  return std::nullopt;
}

/// Parameters of a wheeled robot without a map, chosen on the courses 901 to 920. The maximum speeds are those of the
/// built-in stack.
NavigationSettings wheeled_settings(const YAML::Node& built_in) {
  const YAML::Node dwa = built_in["local_planner"]["dwa"];
  return {.speed_mps = dwa["max_speed_mps"].as<double>(),
          .yaw_rate_radps = dwa["max_yaw_rate_radps"].as<double>(),
          .margin_m = 0.05,
          .ref_distance_m = 3.0,
          .resolution_m = 0.03,
          .full_speed = 0.35,
          .too_close = 0.02,
          .score = "free_distance + 3 * nearness + 0.3 * same_as_before + toward_target",
          .planner_radii_m = {0.5, 0.42, 0.39, 0.36},
          .min_occupancy = 0.8,
          .carrot_m = 2.0,
          .carrot_clearance_m = 0.42,
          .undocking_m = 0.0,
          .turning_radius_m = 0.6,
          .backing_up_m = 0.5};
}

}  // namespace

Task task_of(const StackClient& client) {
  const patrol::link::Hello& hello = client.hello();
  const YAML::Node stack = YAML::Load(hello.documents)["stack"];
  const nlohmann::json site = nlohmann::json::parse(hello.site);
  Task task{.robot = robot_of(hello.robot), .map = given_map(client), .seed = hello.seed};
  if (task.robot.tracks) {
    task.ticks_per_turn = stack["odometry"]["tracked"]["ticks_per_sprocket_turn"].as<double>();
  } else if (task.robot.wheels.empty() ||
             patrol::wheel_drive_type(task.robot) != patrol::WheelDriveType::kDifferential) {
    throw std::runtime_error("the robot has neither tracks nor wheels that are not steered");
  } else {
    task.navigation = wheeled_settings(stack["navigation"]);
  }
  const Pose2 T_site_start = pose_of(site.at("start"));
  const Pose2 T_site_map =
      hello.registration.empty() ? T_site_start : pose_of(nlohmann::json::parse(hello.registration));
  task.T_map_start = T_site_map.inverse() * T_site_start;
  if (!hello.goals.empty()) {
    for (const nlohmann::json& goal : nlohmann::json::parse(hello.goals)) task.goals.push_back(pose_of(goal));
  } else {
    for (const nlohmann::json& station : site.at("stations")) {
      task.goals.push_back(T_site_map.inverse() * pose_of(station));
      task.stations.push_back(station.at("name").get<std::string>());
    }
  }
  if (task.goals.empty()) throw std::runtime_error("the scenario gives neither saved goals nor stations");
  return task;
}

}  // namespace mrpt_stack
