#include "app/stack/robot_stack.h"

namespace patrol::app {
namespace {

constexpr Time kControlPeriod = std::chrono::milliseconds(50);
constexpr Time kOdometryPeriod = std::chrono::milliseconds(20);

}  // namespace

RobotStack::RobotStack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                       double map_period_s, std::uint64_t seed)
    : navigator_(settings.plan, robot, site_in_map.keep_out_lines, seed),
      sensor_watch_(settings.sensor_watch),
      settle_(from_seconds(settings.settle_s)),
      map_period_(from_seconds(map_period_s)) {}

void RobotStack::handle(const SensorMessage& message) {
  if (sensor_watch_.hear(message, now_)) use(message);
}

void RobotStack::step(Time now) {
  now_ = now;
  const std::optional<OdometryEstimate> odometry = this->odometry();
  if (!odometry) return;
  if (!first_odometry_) first_odometry_ = odometry->stamp;
  if (now >= next_odometry_) {
    next_odometry_ += kOdometryPeriod;
    say(*odometry);
  }
  if (is_mapping() && now >= next_map_) {
    next_map_ += map_period_;
    publish_map(now);
  }
  if (now < next_control_) return;
  next_control_ += kControlPeriod;
  const auto lap = clock_.lap("planning");
  const Pose2 T_odom_body = to_planar(odometry->T_odom_body);
  watch_sensors(now, T_odom_body);
  command_ = control(now, *odometry);
  if (!sensor_watch_.can_drive() && drives_itself()) command_ = {};
  command_.stamp = now;
  say(command_);
}

void RobotStack::watch_sensors(Time now, const Pose2& T_odom_body) {
  const PoseEstimate pose = tracker_.at(now, T_odom_body);
  for (const plan::SensorChange& change : sensor_watch_.step(now, T_odom_body, command_)) {
    note(now, pose, change.is_back ? EventKind::kSensorRecovered : EventKind::kSensorFault, change.text, change.sensor);
  }
  if (sensor_watch_.has_given_up(now) && !mission_is_over()) abort(now, EventKind::kSensorFailed, "A sensor that driving needs did not come back: the mission is over.");
}

void RobotStack::map_scan(slam::Mapper& slam, const LevelScan& scan, const Pose2& T_odom_body) {
  const auto lap = clock_.lap("slam");
  const slam::SlamUpdate update = slam.update(scan, T_odom_body);
  tracker_.correct(scan.stamp, T_odom_body, update.T_map_body, update.covariance);
  say(PoseEstimate{scan.stamp, update.T_map_body, update.covariance});
  if (!update.is_keyframe) return;
  if (ParticleSet particles = slam.particles(); !particles.T_map_body.empty()) say(std::move(particles));
}

plan::NavigationStep RobotStack::navigate(Time now, const PoseEstimate& pose) {
  plan::NavigationStep step = navigator_.step(now, pose.T_map_body);
  if (step.replanned) say(Path{now, step.path});
  if (step.is_detour) note(now, pose, EventKind::kReplan, "Something stands on the path: a new one is planned.");
  if (!step.text.empty()) note(now, pose, EventKind::kNavigation, step.text);
  if (!step.recovery.empty()) note(now, pose, EventKind::kRecovery, step.recovery);
  navigation_ = step.status;
  return step;
}

inspect::NavigationFeedback RobotStack::navigation_feedback() const {
  switch (navigation_) {
    case plan::NavigationStatus::kArrived:
      return inspect::NavigationFeedback::kArrived;
    case plan::NavigationStatus::kFailed:
      return inspect::NavigationFeedback::kFailed;
    default:
      return inspect::NavigationFeedback::kDriving;
  }
}

void RobotStack::note(Time now, const PoseEstimate& pose, EventKind kind, const std::string& text, const std::string& subject) {
  say(Event{.stamp = now, .kind = kind, .subject = subject, .text = text, .value = 0.0, .T_map_body = pose.T_map_body,
            .p_map_target = pose.T_map_body.position()});
}

void RobotStack::publish_map(Time now) {
  const auto lap = clock_.lap("slam");
  MapUpdate update{now, map()};
  navigator_.set_map(update.map);
  say(std::move(update));
}

}  // namespace patrol::app
