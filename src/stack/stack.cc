#include "stack/stack.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "core/cycle.h"
#include "core/overloaded.h"

namespace patrol::stack {
namespace {

constexpr Time kControlPeriod = std::chrono::milliseconds(50);
constexpr Time kOdometryPeriod = std::chrono::milliseconds(20);

}  // namespace

Stack::Stack(StackParts parts) : parts_(std::move(parts)), map_period_(from_seconds(parts_.map_period_s)) {
  parts_.motion.set_map(parts_.pose.map());  // the map may still be empty, but its resolution must match the costmap
  if (parts_.mission->starts_at_survey()) parts_.pose.start_at_survey();
}

void Stack::handle(const SensorMessage& message, Time received) {
  if (!parts_.sensor_monitor.receive(message, received)) return;
  const auto station_pose_at = [this](Time stamp) { return parts_.pose.station_pose_at(stamp); };
  std::visit(Overloaded{
                 [&](const LaserScan& scan) { handle_scan(scan, received); },
                 [&](const UltrasonicRange& range) {
                   if (const auto station_pose = station_pose_at(range.stamp)) parts_.motion.add(range, *station_pose);
                 },
                 [&](const DepthImage& image) {
                   const auto timer = output_.time_stage("planning");
                   if (const auto station_pose = station_pose_at(image.stamp)) parts_.motion.add(image, *station_pose);
                 },
                 [&](const TeleopCommand& command) {
                   new_teleop_ = command;
                   parts_.motion.add(command);
                 },
                 [&](const auto&) { parts_.pose.add(message, output_); },
             },
             message);
  parts_.instruments.add(message, station_pose_at);
}

void Stack::handle_scan(const LaserScan& raw, Time received) {
  const std::optional<LevelScan> scan = parts_.pose.level(raw, output_);
  if (!scan) return;
  const ScanPose pose = parts_.pose.localize(*scan, received, output_);
  const auto timer = output_.time_stage("planning");
  if (const std::optional<DockDetection> dock = parts_.motion.add(*scan, pose)) parts_.pose.add(*dock);
}

void Stack::handle_fall(Time now) {
  if (!mission_is_over()) output_.publish(parts_.mission->abort(now, EventKind::kFall, "The robot fell."));
}

void Stack::step(Time now) {
  const std::optional<OdometryEstimate> odometry = parts_.pose.update_odometry();
  parts_.pose.correct(now, output_);
  if (!odometry) return;
  if (now >= next_odometry_) {
    next_odometry_ = next_in_cycle(next_odometry_, kOdometryPeriod, now);
    output_.publish(*odometry);
  }
  parts_.pose.publish_calibration(now, output_);
  if (parts_.pose.is_mapping() && now >= next_map_) {
    next_map_ = next_in_cycle(next_map_, map_period_, now);
    publish_map(now);
  }
  if (now < next_control_) return;
  next_control_ = next_in_cycle(next_control_, kControlPeriod, now);
  const auto timer = output_.time_stage("planning");
  const Pose2 T_odom_body = to_pose2(odometry->T_odom_body);
  monitor_sensors(now, T_odom_body);
  follow_registration(now);
  command_ = control({.now = now,
                      .odometry = *odometry,
                      .T_odom_body = T_odom_body,
                      .pose = parts_.pose.pose_at(odometry->stamp, T_odom_body)});
  if (!parts_.sensor_monitor.can_drive() && !parts_.motion.is_teleoperated()) command_ = {};
  command_.stamp = now;
  output_.publish(command_);
}

Time Stack::next_step() const {
  const Time next = std::min(next_odometry_, next_control_);
  return parts_.pose.is_mapping() ? std::min(next, next_map_) : next;
}

void Stack::publish_map(Time now) {
  const auto timer = output_.time_stage("slam");
  MapUpdate update{now, parts_.pose.map()};
  parts_.motion.set_map(update.map);
  output_.publish(std::move(update));
}

/// Completes the map; everything that the robot has located in it follows its final optimization. Aborts the mission if
/// no scan was used for the map: no localizer works on it.
void Stack::finish_map(Time now, const OdometryEstimate& odometry) {
  if (const std::optional<std::string> failure = parts_.pose.mapping_failure()) {
    if (!mission_is_over()) output_.publish(parts_.mission->abort(now, EventKind::kMissionFailed, *failure));
    return publish_map(now);
  }
  {
    const auto timer = output_.time_stage("slam");
    const std::optional<localize::MapCorrection> correction = parts_.pose.finish_map(odometry, output_);
    if (!correction) return;
    for (Event& event : parts_.mission->correct_map(now, *correction)) output_.publish(std::move(event));
  }
  publish_map(now);
  follow_registration(now);
}

void Stack::finish(Time now) {
  const std::optional<OdometryEstimate> odometry = parts_.pose.update_odometry();
  if (odometry && parts_.pose.is_mapping()) return finish_map(now, *odometry);
  publish_map(now);
}

/// Moves the survey in map with the registration of the map to the site.
void Stack::follow_registration(Time now) {
  const std::optional<SiteRegistration> registration = parts_.pose.register_to_site(now);
  if (!registration) return;
  output_.publish(*registration);
  const std::optional<Route> site_in_map = parts_.site.update(*registration);
  if (!site_in_map) return;
  parts_.mission->set_site(*site_in_map);
  parts_.motion.set_site(*site_in_map);
  parts_.pose.set_site(*site_in_map);
  parts_.dock = site_in_map->dock;
}

void Stack::monitor_sensors(Time now, const Pose2& T_odom_body) {
  const Pose2 T_map_body = parts_.pose.pose_at(now, T_odom_body).T_map_body;
  for (const SensorChange& change :
       parts_.sensor_monitor.step(now, T_odom_body, command_, parts_.pose.lidar_clock(now))) {
    output_.publish_event(now, T_map_body, change.has_recovered ? EventKind::kSensorRecovered : EventKind::kSensorFault,
                          change.text, change.sensor);
  }
  if (!parts_.sensor_monitor.must_abort(now) || mission_is_over()) return;
  output_.publish(
      parts_.mission->abort(now, EventKind::kSensorFailed, "Required sensor did not recover: mission aborted."));
}

VelocityCommand Stack::control(const Period& period) {
  if (parts_.mission->timing() == TaskTiming::kNow) {
    advance_mission(period);
    inspect(period);
    parts_.pose.publish_range_pose(period.odometry, period.pose, output_);
    return drive(period);
  }
  const VelocityCommand command = drive(period);
  parts_.pose.publish_range_pose(period.odometry, period.pose, output_);
  inspect(period);
  advance_mission(period);
  return command;
}

void Stack::advance_mission(const Period& period) {
  MissionOutput output =
      parts_.mission->step(period.now, {.pose = period.pose,
                                        .is_lost = parts_.pose.is_lost(),
                                        .awaits_first_scan = parts_.pose.awaits_first_scan(period.now),
                                        .navigation = parts_.motion.navigation(),
                                        .docking = parts_.motion.docking(),
                                        .inspection = inspection_,
                                        .teleop = std::exchange(new_teleop_, std::nullopt)});
  for (Event& event : output.events) output_.publish(std::move(event));
  if (output.is_map_complete) {
    // The mission may be over, with a drive that saved no goals: report the failure all the same.
    if (const std::optional<std::string> failure = parts_.pose.mapping_failure())
      output_.publish(parts_.mission->abort(period.now, EventKind::kMissionFailed, *failure));
    finish_map(period.now, period.odometry);
  }
  relocalize(output.relocalization, period.odometry);
  task_ = std::move(output.task);
}

void Stack::relocalize(Relocalization how, const OdometryEstimate& odometry) {
  if (how == Relocalization::kAnywhere) parts_.pose.start_global_localization();
  if (how == Relocalization::kAtDock) parts_.pose.restart_at(parts_.dock->T_route_docked, odometry);
}

void Stack::inspect(const Period& period) {
  const auto timer = output_.time_stage("inspection");
  const StationPose here = parts_.pose.station_pose_at(period.odometry.stamp)
                               .value_or(StationPose{.T_level_body = {}, .T_map_body = period.pose.T_map_body});
  inspection_ = parts_.instruments.step(period.now, task_.inspection, here, output_);
}

VelocityCommand Stack::drive(const Period& period) {
  return parts_.motion.step(period.now, task_, period.pose.T_map_body, period.T_odom_body, output_);
}

}  // namespace patrol::stack
