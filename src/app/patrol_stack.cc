#include "app/patrol_stack.h"

#include <utility>

namespace patrol::app {
namespace {

constexpr Time kControlPeriod = std::chrono::milliseconds(50);
constexpr Time kOdometryPeriod = std::chrono::milliseconds(20);

}  // namespace

PatrolStack::PatrolStack(const StackSettings& settings, const RobotDescription& robot, const Route& route_in_map,
                       double map_period_s, std::uint64_t seed)
    : odometry_(robot, settings.odometry),
      leveler_(robot.T_body("lidar"), settings.leveling),
      slam_(settings.slam, seed),
      navigator_(settings.navigation, robot, route_in_map.keep_out_lines),
      mission_(settings.mission, route_in_map, robot.T_body("tdlas")),
      settle_(from_seconds(settings.settle_s)),
      map_period_(from_seconds(map_period_s)) {
  navigator_.set_map(slam_.map());  // empty yet, but its resolution must suit the costmap's
}

void PatrolStack::handle(const SensorMessage& message) {
  std::visit(Overloaded{
                 [&](const LaserScan& scan) { handle_scan(scan); },
                 [&](const GasReading& reading) { newest_gas_ = reading; },
                 [&](const Imu& imu) {
                   const auto lap = clock_.lap("odometry");
                   odometry_.add(imu);
                 },
                 [&](const JointState& joints) {
                   const auto lap = clock_.lap("odometry");
                   odometry_.add(joints);
                 },
                 [&](const FootContacts& contacts) {
                   const auto lap = clock_.lap("odometry");
                   odometry_.add(contacts);
                 },
                 [](const auto&) {},  // GNSS and the 3D cloud are logged, not used: the 2D stack needs neither
             },
             message);
}

// Level, match, correct the map pose, and show the planner what stands there now.
void PatrolStack::handle_scan(const LaserScan& raw) {
  if (!first_odometry_ || raw.stamp < *first_odometry_ + settle_) return;
  std::optional<LevelScan> scan;
  {
    const auto lap = clock_.lap("odometry");
    scan = leveler_.level(raw, odometry_);
  }
  if (!scan) return;
  const Pose2 T_odom_body = to_planar(*odometry_.T_odom_body_at(scan->stamp));
  {
    const auto lap = clock_.lap("slam");
    const slam::SlamUpdate update = slam_.update(*scan, T_odom_body);
    tracker_.correct(scan->stamp, T_odom_body, update.T_map_body, update.covariance);
    messages_.emplace_back(PoseEstimate{scan->stamp, update.T_map_body, update.covariance});
    if (update.is_keyframe) messages_.emplace_back(slam_.particles());
  }
  const auto lap = clock_.lap("planning");
  navigator_.add_scan(*scan, tracker_.at(scan->stamp, T_odom_body).T_map_body);
}

void PatrolStack::handle_fall(Time now) {
  if (!mission_.is_over()) messages_.emplace_back(mission_.abort(now, "fall", "The robot fell."));
}

void PatrolStack::step(Time now) {
  const std::optional<OdometryEstimate> odometry = odometry_.estimate();
  if (!odometry) return;
  if (!first_odometry_) first_odometry_ = odometry->stamp;
  if (now >= next_odometry_) {
    next_odometry_ += kOdometryPeriod;
    messages_.emplace_back(*odometry);
  }
  if (now >= next_map_) {
    next_map_ += map_period_;
    publish_map(now);
  }
  if (now < next_control_) return;
  next_control_ += kControlPeriod;

  const auto lap = clock_.lap("planning");
  const PoseEstimate pose = tracker_.at(odometry->stamp, to_planar(odometry->T_odom_body));
  const plan::NavigationStep drive = navigator_.step(now, pose.T_map_body);
  if (drive.replanned) messages_.emplace_back(Path{now, drive.path});
  if (drive.is_detour) note(now, pose, "replan", "Something stands on the path: a new one is planned.");
  if (drive.status == plan::NavigationStatus::kRecovering && status_ != drive.status) {
    note(now, pose, "recovery", "Blocked for too long: backing up.");
  }
  status_ = drive.status;
  const inspect::MissionOutput output = mission_.step(now, pose, feedback_of(drive.status), newest_gas_);
  for (const Event& event : output.events) messages_.emplace_back(event);
  navigator_.set_goal(output.goal);
  command_ = drive.command;
  command_.stamp = now;
  messages_.emplace_back(command_);
}

void PatrolStack::note(Time now, const PoseEstimate& pose, const char* kind, const char* text) {
  messages_.emplace_back(Event{.stamp = now, .kind = kind, .subject = "", .text = text, .value = 0.0,
                               .T_map_body = pose.T_map_body, .p_map_target = pose.T_map_body.position()});
}

void PatrolStack::publish_map(Time now) {
  const auto lap = clock_.lap("slam");
  MapUpdate update{now, slam_.map()};
  navigator_.set_map(update.map);
  messages_.emplace_back(std::move(update));
}

}  // namespace patrol::app
