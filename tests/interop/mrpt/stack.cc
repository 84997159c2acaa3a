#include "stack.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "conversions.h"

namespace mrpt_stack {
namespace {

constexpr Time kPeriod = std::chrono::milliseconds(100);
constexpr Time kSettling = std::chrono::seconds(4);  ///< standing time for the bias of the gyro
constexpr double kObstacleRange_m = 8.0;

std::unique_ptr<Positioning> positioning_for(const Task& task) {
  const patrol::Pose3& T_body_lidar = task.robot.T_body("lidar");
  if (task.map) return std::make_unique<Localization>(*task.map, task.T_map_start, T_body_lidar, task.seed);
  return std::make_unique<ScanMap>(task.goals, T_body_lidar);
}

/// Folder of the collision grids, which MRPT computes in seconds and names by their number only.
std::filesystem::path cache_of(const std::string& robot) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("mrpt_stack_" + robot);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace

Stack::Stack(patrol::link::StackClient client)
    : client_(std::move(client)),
      task_(task_of(client_)),
      T_body_lidar_(task_.robot.T_body("lidar")),
      odometry_(task_.robot, task_.ticks_per_turn),
      positioning_(positioning_for(task_)),
      navigation_(task_.robot.footprint_m, task_.goals, task_.navigation, cache_of(task_.robot.name)) {
  if (task_.robot.tracks)
    low_obstacles_.emplace(task_.robot.T_body("depth_camera"), -task_.robot.tracks->body_height_m);
}

std::vector<std::string> Stack::topics() const {
  using patrol::io::kTopic;
  if (task_.robot.tracks) {
    return {kTopic<patrol::LaserScan>, kTopic<patrol::Imu>, kTopic<patrol::TrackTicks>, kTopic<patrol::DepthImage>};
  }
  return {kTopic<patrol::LaserScan>, kTopic<patrol::Imu>, kTopic<patrol::JointState>};
}

void Stack::receive(const patrol::link::ReceivedTurn& turn) {
  using patrol::io::decode, patrol::io::kTopic;
  scan_.reset();
  for (const patrol::link::DeliveredMessage& message : turn.messages) {
    if (message.topic == kTopic<patrol::Imu>) {
      odometry_.add(decode<patrol::Imu>(message.cdr));
    } else if (message.topic == kTopic<patrol::TrackTicks>) {
      odometry_.add(decode<patrol::TrackTicks>(message.cdr));
    } else if (message.topic == kTopic<patrol::JointState>) {
      odometry_.add(decode<patrol::JointState>(message.cdr));
    } else if (message.topic == kTopic<patrol::DepthImage>) {
      low_obstacles_->add(decode<patrol::DepthImage>(message.cdr), odometry_.pose());
    } else {
      scan_ = decode<patrol::LaserScan>(message.cdr);
      positioning_->update(*scan_, odometry_);
    }
  }
}

void Stack::set_obstacles(const patrol::LaserScan& scan, Time now) {
  mrpt::maps::CSimplePointsMap obstacles;
  if (low_obstacles_) {
    obstacles.loadFromRangeScan(to_mrpt(scan, T_body_lidar_));
    low_obstacles_->append_to(obstacles, now, odometry_.pose());
  } else {
    const Pose2 T_body_odom = odometry_.pose().inverse();
    for (const Eigen::Vector2d& p_odom : to_points(scan, T_body_lidar_, odometry_, kObstacleRange_m)) {
      const Eigen::Vector2d p = T_body_odom * p_odom;
      obstacles.insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F);
    }
  }
  navigation_.set_obstacles(obstacles);
}

void Stack::publish_state(Time now) {
  client_.publish(now, patrol::PoseEstimate{now, T_map_body(), positioning_->covariance()});
  client_.publish(now, patrol::OdometryEstimate{.stamp = now,
                                                .T_odom_body = patrol::to_pose3(odometry_.pose()),
                                                .twist = {.linear = {odometry_.speed_mps(), 0.0, 0.0},
                                                          .angular = {0.0, 0.0, odometry_.yaw_rate_radps()}}});
}

void Stack::report_goals(Time now) {
  const auto event = [&](patrol::EventKind kind, const std::string& subject, const std::string& text, double value) {
    return patrol::Event{.stamp = now,
                         .kind = kind,
                         .subject = subject,
                         .text = text,
                         .value = value,
                         .T_map_body = T_map_body(),
                         .p_map_target = T_map_body().position()};
  };
  for (; num_reported_ < navigation_.num_reached(); ++num_reported_) {
    const bool is_station = num_reported_ < task_.stations.size();
    client_.publish(now, is_station ? event(patrol::EventKind::kStationReached, task_.stations[num_reported_],
                                            "Station reached.", 0.0)
                                    : event(patrol::EventKind::kGoalReached,
                                            "goal_" + std::to_string(num_reported_ + 1), "Goal reached.", 1.0));
    if (navigation_.is_over() && num_reported_ + 1 == task_.goals.size())
      client_.publish(now, event(patrol::EventKind::kMissionCompleted, "", "All goals reached.", 0.0));
  }
}

void Stack::run() {
  client_.begin("mrpt", topics(), kPeriod);
  while (true) {
    const patrol::link::ReceivedTurn turn = client_.next_turn();
    receive(turn);
    publish_state(turn.now);
    if (turn.now >= kSettling && !turn.is_last) {
      if (scan_) set_obstacles(*scan_, turn.now);
      client_.publish(turn.now, navigation_.step(turn.now, *positioning_, odometry_));
      client_.publish(turn.now, patrol::Path{turn.now, navigation_.path()});
    }
    report_goals(turn.now);
    client_.done({.now = turn.now, .next_turn = {}, .mission_is_over = navigation_.is_over()});
    if (turn.is_last) return;
  }
}

}  // namespace mrpt_stack
