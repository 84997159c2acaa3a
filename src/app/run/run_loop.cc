#include "app/run/run_loop.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <utility>

#include "core/geometry/angles.h"
#include "core/overloaded.h"
#include "inspect/route_frame.h"
#include "io/logs/run_log.h"
#include "render/scene/depth_renderer.h"
#include "stack/make_stack.h"

namespace patrol::app {
namespace {

/// Clock divider: `is_due` is true once per period, beginning with the first call.
class Schedule {
 public:
  explicit Schedule(double rate_hz) : period_(from_seconds(1.0 / rate_hz)) {}
  bool is_due(Time now) {
    if (now < next_) return false;
    next_ += period_;
    return true;
  }

 private:
  Time period_;
  Time next_{};
};

/// Message that is a command to the simulator's instruments.
template <typename Message>
concept InstrumentOrder = std::is_constructible_v<InstrumentCommand, Message>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

sim::SimulatorSettings simulator_settings(const Scenario& scenario, const ScenarioFiles& files) {
  return {.world_xml = files.world_xml.string(),
          .robot_urdf = files.robot_urdf.string(),
          .T_world_start = start_in_world(scenario, files),
          .sensors = scenario.sensors,
          .locomotion = scenario.locomotion,
          .track_drive = scenario.track_drive,
          .props = static_obstacles_of(scenario),
          .lining = files.route.lining,  // site is world
          .lining_deformations = scenario.lining,
          .actors = scenario.actors,
          .leaks = scenario.leaks,
          .wind = scenario.wind,
          .subsurface = {.rock = scenario.rock, .water = scenario.water},
          .faults = scenario.faults,
          .drive = files.drive,
          .driver = scenario.remote.driver,
          .recorded = files.recorded};
}

stack::LiningReferences references_of(const ScenarioFiles& files) {
  stack::LiningReferences references;
  for (const io::StationScan& scan : files.references) {
    references.emplace(scan.station, inspect::LiningReference{.T_map_scanner = scan.T_map_scanner, .points = scan.points});
  }
  return references;
}

}  // namespace

Pose2 start_in_world(const Scenario& scenario, const ScenarioFiles& files) {
  return files.T_site_start * Pose2{scenario.start.ahead_m, scenario.start.left_m,
                                    to_rad(scenario.start.turn_deg)};
}

std::vector<sim::StaticObstacleSettings> static_obstacles_of(const Scenario& scenario) {
  std::vector<sim::StaticObstacleSettings> props = scenario.props;
  const std::vector<sim::StaticObstacleSettings> scattered = sim::scatter_low_obstacles(scenario.low_obstacles, scenario.seed);
  props.insert(props.end(), scattered.begin(), scattered.end());
  return props;
}

sim::Simulator make_simulator(const Scenario& scenario, const ScenarioFiles& files) {
  return sim::Simulator(simulator_settings(scenario, files), files.robot, scenario.seed, render::make_depth_renderer);
}

stack::Stack make_stack(const Scenario& scenario, const ScenarioFiles& files) {
  return stack::make_stack(scenario.stack, files.robot, inspect::to_map(files.route, files.T_site_start),
                           {.map = files.map,
                            .goals = files.goals,
                            .references = references_of(files),
                            .neighbor_model = files.neighbor_model,
                            .has_teleop = files.has_teleop(),
                            .map_period_s = scenario.log.map_period_s,
                            .seed = scenario.seed});
}

RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, sim::Simulator& simulator, stack::Stack& stack,
                    const std::filesystem::path& log_mcap, RunObserver& observer) {
  const auto wall_start = std::chrono::steady_clock::now();
  const double cpu_start = cpu_seconds();

  io::RunLogWriter log(log_mcap, files.robot);
  StageProfiler clock;

  Schedule truth_due(scenario.log.truth_rate_hz), state_due(scenario.log.state_rate_hz);
  Schedule progress_due(2.0);
  const Time limit = from_seconds(scenario.time_limit_s);
  double distance_m = 0.0;
  Eigen::Vector3d last_position = simulator.truth().T_world_body.position;
  RunOutcome outcome;
  std::vector<KidnapSettings> kidnaps = scenario.kidnaps;
  std::stable_sort(kidnaps.begin(), kidnaps.end(), [](const auto& a, const auto& b) { return a.at_s < b.at_s; });

  const auto write_stack_messages = [&](Time now) {
    for (const stack::StackMessage& message : stack.take_messages()) {
      const auto timer = clock.time_stage("log");
      std::visit(Overloaded{[&](const auto& content) { log.write(now, content); },
                            [&]<InstrumentOrder Command>(const Command& order) {
                              log.write(now, order);
                              simulator.command(order);
                            }},
                 message);
      observer.on_message(message);
    }
  };

  observer.begin(files);
  for (bool running = true; running;) {
    const Time now = simulator.now();
    for (const SensorMessage& message : simulator.take_messages()) {
      {
        const auto timer = clock.time_stage("log");
        log.write(now, message);
      }
      stack.handle(message);
    }
    if (simulator.has_fallen()) {
      stack.handle_fall(now);
      outcome.end = RunEnd::kFall;
    }
    stack.step(now);
    write_stack_messages(now);
    simulator.set_command(stack.command());

    const auto is_kidnapped = [&](const KidnapSettings& kidnap) { return from_seconds(kidnap.at_s) <= now; };
    while (outcome.num_kidnaps < kidnaps.size() && is_kidnapped(kidnaps[outcome.num_kidnaps])) {
      const KidnapSettings& kidnap = kidnaps[outcome.num_kidnaps++];
      simulator.teleport({kidnap.x_m, kidnap.y_m, to_rad(kidnap.heading_deg)});
    }
    const GroundTruth truth = simulator.truth();
    for (const Collision& collision : simulator.take_collisions()) log.write(now, collision);
    if (truth_due.is_due(now)) {
      distance_m += (truth.T_world_body.position - last_position).head<2>().norm();
      last_position = truth.T_world_body.position;
      log.write(now, truth);
      observer.on_ground_truth(truth);
    }
    if (state_due.is_due(now)) log.write(now, simulator.state());

    running = !stack.mission_is_over() && now < limit;
    if (now >= limit) outcome.end = RunEnd::kTimeLimit;
    if (progress_due.is_due(now) && !observer.keep_running(now, distance_m)) {
      outcome.end = RunEnd::kInterrupted;
      running = false;
    }
    if (running) simulator.step();
  }

  const MapUpdate final_map = stack.final_map(simulator.now());
  log.write(simulator.now(), final_map);
  observer.on_message(stack::StackMessage(final_map));
  log.close();
  outcome.duration = simulator.now();
  outcome.faults = simulator.sensors().faults();
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  outcome.cpu_s = cpu_seconds() - cpu_start;
  for (const StageProfiler* part : {&simulator.clock(), &stack.clock(), &std::as_const(clock)}) {
    for (const auto& [name, seconds] : part->seconds()) outcome.seconds_by_stage[name] += seconds;
  }
  // Expensive sensors are stages of their own.
  for (const auto& [name, seconds] : simulator.sensors().clock().seconds()) {
    outcome.seconds_by_stage[name] += seconds;
    outcome.seconds_by_stage["sensors"] -= seconds;
  }
  return outcome;
}

}  // namespace patrol::app
