// Feeds the sensor messages of a recorded log to the robot's software, and saves the map that it makes.
#include <cstdio>
#include <filesystem>

#include "inspect/route_frame.h"
#include "io/json/route_json.h"
#include "io/logs/run_log.h"
#include "io/maps/map_server.h"
#include "io/urdf.h"
#include "stack/make_stack.h"

int main(int argc, char** argv) {
  if (argc != 5) return std::puts("usage: stack_example ROBOT.urdf MISSION.json LOG.mcap MAP.yaml"), 2;
  const patrol::io::RouteFile site = patrol::io::load_route(argv[2]);
  patrol::stack::StackSettings settings;
  settings.slam.graph.edge_std_m = 0.02;  // as in models/quadruped/quadruped.yaml
  settings.slam.graph.edge_std_rad = 0.003;
  patrol::stack::Stack stack = patrol::stack::make_stack(
      settings, patrol::io::load_robot_description(argv[1]), patrol::inspect::to_map(site.route, site.T_site_start),
      {.site = {.T_site_start = site.T_site_start, .datum = site.datum}, .seed = 1});
  patrol::Time now{};
  const auto feed = [&](patrol::Time log_time, const auto& message) {
    if (log_time > now) stack.step(now);  // all messages of that tick are there
    now = log_time;
    stack.handle(message, log_time);
  };
  patrol::io::LogHandlers handlers;
  handlers.on<patrol::LaserScan>(feed);
  handlers.on<patrol::Imu>(feed);
  handlers.on<patrol::JointState>(feed);
  handlers.on<patrol::FootContacts>(feed);
  handlers.on<patrol::GasReading>(feed);
  handlers.on<patrol::GnssFix>(feed);
  patrol::io::read_run_log(argv[3], handlers);
  stack.finish(now);
  const std::vector<patrol::stack::StackMessage> messages = stack.take_messages();
  patrol::OccupancyGrid map;
  for (const patrol::stack::StackMessage& message : messages) {
    if (const auto* update = std::get_if<patrol::MapUpdate>(&message)) map = update->map;
  }
  patrol::io::save_map(argv[4], map);
  std::printf("%zu messages published; map of %d x %d cells\n", messages.size(), map.geometry().width,
              map.geometry().height);
  return 0;
}
