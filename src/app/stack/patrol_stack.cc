#include "app/stack/patrol_stack.h"

#include "app/stack/station_order.h"
#include "core/overloaded.h"

namespace patrol::app {
namespace {

inspect::Mission make_mission(const StackSettings& settings, const RobotDescription& robot, Route route_in_map, std::uint64_t seed) {
  std::string about_order;
  if (settings.mission.order == "best" && !route_in_map.stations.empty()) {
    StationOrder order = order_stations(route_in_map, robot, settings.plan, settings.mission, seed);
    route_in_map.stations = std::move(order.stations);
    about_order = std::move(order.text);
  }
  return inspect::Mission(settings.mission, std::move(route_in_map), robot.T_body("tdlas"), std::move(about_order));
}

}  // namespace

PatrolStack::PatrolStack(const StackSettings& settings, const RobotDescription& robot, const Route& route_in_map,
                       double map_period_s, std::uint64_t seed, const BoostedStumps& neighbours)
    : RobotStack(settings, robot, route_in_map, map_period_s, seed),
      odometry_(robot, settings.odometry),
      leveler_(robot.T_body("lidar"), settings.leveling),
      slam_(make_mapper(settings, neighbours, seed)),
      mission_(make_mission(settings, robot, route_in_map, seed)) {
  navigator_.set_map(slam_->map());  // empty yet, but its resolution must suit the costmap's
}

void PatrolStack::use(const SensorMessage& message) {
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
  if (!has_settled(raw.stamp)) return;
  std::optional<LevelScan> scan;
  {
    const auto lap = clock_.lap("odometry");
    scan = leveler_.level(raw, odometry_);
  }
  if (!scan) return;
  const Pose2 T_odom_body = to_planar(*odometry_.T_odom_body_at(scan->stamp));
  map_scan(*slam_, *scan, T_odom_body);
  const auto lap = clock_.lap("planning");
  navigator_.add_scan(*scan, tracker_.at(scan->stamp, T_odom_body).T_map_body);
}

void PatrolStack::handle_fall(Time now) {
  if (!mission_.is_over()) abort(now, EventKind::kFall, "The robot fell.");
}

VelocityCommand PatrolStack::control(Time now, const OdometryEstimate& odometry) {
  const PoseEstimate pose = tracker_.at(odometry.stamp, to_planar(odometry.T_odom_body));
  const plan::NavigationStep drive = navigate(now, pose);
  const inspect::MissionOutput output = mission_.step(now, pose, navigation_feedback(), newest_gas_);
  for (const Event& event : output.events) say(event);
  navigator_.set_goal(output.goal);
  return drive.command;
}

}  // namespace patrol::app
