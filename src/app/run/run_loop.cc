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
          .as_built = scenario.as_built,
          .sensors = scenario.sensors,
          .locomotion = scenario.locomotion,
          .track_drive = scenario.track_drive,
          .static_obstacles = all_static_obstacles(scenario),
          .lining = files.route.lining,  // site is world
          .lining_deformations = scenario.lining_deformation,
          .actors = scenario.actors,
          .leaks = scenario.leaks,
          .wind = scenario.wind,
          .subsurface = {.rock = scenario.rock, .water_bodies = scenario.water_bodies},
          .faults = scenario.faults,
          .teleop_route = files.teleop_route,
          .teleop_operator = scenario.teleop.teleop_operator,
          .recorded = files.recorded};
}

stack::LiningReferences references_of(const ScenarioFiles& files) {
  stack::LiningReferences references;
  for (const io::StationScan& scan : files.references) {
    references.emplace(scan.station,
                       inspect::LiningReference{.T_map_scanner = scan.T_map_scanner, .points = scan.points});
  }
  return references;
}

/// Closed loop of simulator and stack: exchanges their messages, writes the log and notifies the observer.
class ClosedLoop {
 public:
  ClosedLoop(const Scenario& scenario, const ScenarioFiles& files, sim::Simulator& simulator, stack::Stack& stack,
             const std::filesystem::path& log_mcap, RunObserver& observer)
      : simulator_(simulator),
        stack_(stack),
        observer_(observer),
        log_(log_mcap, files.robot),
        truth_due_(scenario.log.truth_rate_hz),
        state_due_(scenario.log.state_rate_hz),
        limit_(from_seconds(scenario.time_limit_s)),
        kidnaps_(scenario.kidnaps),
        last_position_(simulator.truth().T_world_body.position) {
    std::stable_sort(kidnaps_.begin(), kidnaps_.end(), [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  }

  RunOutcome run(const ScenarioFiles& files) {
    observer_.begin(files);
    if (const AsBuiltTruth as_built = simulator_.as_built(); !as_built.values.empty()) log_.write(Time{}, as_built);
    for (bool is_running = true; is_running;) {
      const Time now = simulator_.now();
      handle_sensor_messages(now);
      if (simulator_.has_fallen()) {
        stack_.handle_fall(now);
        outcome_.end = RunEnd::kFall;
      }
      stack_.step(now);
      publish_stack_messages(now);
      simulator_.set_command(stack_.command());
      trigger_kidnaps(now);
      record_ground_truth(now);
      is_running = keep_running(now);
      if (is_running) simulator_.step();
    }
    finish();
    return std::move(outcome_);
  }

 private:
  void handle_sensor_messages(Time now) {
    for (const SensorMessage& message : simulator_.take_messages()) {
      {
        const auto timer = profiler_.time_stage("log");
        log_.write(now, message);
      }
      stack_.handle(message);
    }
  }

  void publish_stack_messages(Time now) {
    for (const stack::StackMessage& message : stack_.take_messages()) {
      const auto timer = profiler_.time_stage("log");
      std::visit(Overloaded{[&](const auto& content) { log_.write(now, content); },
                            [&]<InstrumentOrder Command>(const Command& order) {
                              log_.write(now, order);
                              simulator_.command(order);
                            }},
                 message);
      observer_.on_message(message);
    }
  }

  void trigger_kidnaps(Time now) {
    const auto is_due = [&](const KidnapSettings& kidnap) { return from_seconds(kidnap.at_s) <= now; };
    while (outcome_.num_kidnaps < kidnaps_.size() && is_due(kidnaps_[outcome_.num_kidnaps])) {
      const KidnapSettings& kidnap = kidnaps_[outcome_.num_kidnaps++];
      simulator_.teleport({kidnap.x_m, kidnap.y_m, to_rad(kidnap.heading_deg)});
    }
  }

  void record_ground_truth(Time now) {
    const GroundTruth truth = simulator_.truth();
    for (const Collision& collision : simulator_.take_collisions()) log_.write(now, collision);
    if (truth_due_.is_due(now)) {
      distance_m_ += (truth.T_world_body.position - last_position_).head<2>().norm();
      last_position_ = truth.T_world_body.position;
      log_.write(now, truth);
      observer_.on_ground_truth(truth);
    }
    if (state_due_.is_due(now)) log_.write(now, simulator_.state());
  }

  /// Checks the end of the mission, the time limit and the observer, and sets the outcome's end.
  bool keep_running(Time now) {
    if (now >= limit_) outcome_.end = RunEnd::kTimeLimit;
    if (progress_due_.is_due(now) && !observer_.keep_running(now, distance_m_)) {
      outcome_.end = RunEnd::kInterrupted;
      return false;
    }
    return !stack_.mission_is_over() && now < limit_;
  }

  /// Lets the stack complete its map, closes the log and completes the outcome.
  void finish() {
    stack_.finish(simulator_.now());
    publish_stack_messages(simulator_.now());
    log_.close();
    outcome_.duration = simulator_.now();
    outcome_.faults = simulator_.sensors().faults();
    outcome_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
    outcome_.cpu_s = cpu_seconds() - cpu_start_;
    for (const StageProfiler* part : {&simulator_.clock(), &stack_.clock(), &std::as_const(profiler_)}) {
      for (const auto& [name, seconds] : part->seconds()) outcome_.seconds_by_stage[name] += seconds;
    }
    // Expensive sensors are stages of their own.
    for (const auto& [name, seconds] : simulator_.sensors().clock().seconds()) {
      outcome_.seconds_by_stage[name] += seconds;
      outcome_.seconds_by_stage["sensors"] -= seconds;
    }
  }

  const std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
  const double cpu_start_ = cpu_seconds();
  sim::Simulator& simulator_;
  stack::Stack& stack_;
  RunObserver& observer_;
  io::RunLogWriter log_;
  StageProfiler profiler_;
  Schedule truth_due_, state_due_, progress_due_{2.0};
  Time limit_;
  std::vector<KidnapSettings> kidnaps_;  ///< by time
  Eigen::Vector3d last_position_;
  double distance_m_ = 0.0;
  RunOutcome outcome_;
};

}  // namespace

Pose2 start_in_world(const Scenario& scenario, const ScenarioFiles& files) {
  return files.T_site_start * Pose2{scenario.start.ahead_m, scenario.start.left_m, to_rad(scenario.start.yaw_deg)};
}

std::vector<sim::StaticObstacleSettings> all_static_obstacles(const Scenario& scenario) {
  std::vector<sim::StaticObstacleSettings> obstacles = scenario.static_obstacles;
  const std::vector<sim::StaticObstacleSettings> scattered =
      sim::scatter_low_obstacles(scenario.low_obstacles, scenario.seed);
  obstacles.insert(obstacles.end(), scattered.begin(), scattered.end());
  return obstacles;
}

sim::Simulator make_simulator(const Scenario& scenario, const ScenarioFiles& files) {
  return {simulator_settings(scenario, files), files.robot, scenario.seed, render::make_depth_renderer};
}

stack::Stack make_stack(const Scenario& scenario, const ScenarioFiles& files) {
  return stack::make_stack(scenario.stack, files.robot, inspect::to_map(files.route, files.T_site_start),
                           {.map = files.map,
                            .map_registration = files.map_registration,
                            .goals = files.goals,
                            .references = references_of(files),
                            .neighbor_model = files.neighbor_model,
                            .has_teleop = files.has_teleop(),
                            .site = {.T_site_start = files.T_site_start, .datum = files.datum},
                            .map_period_s = scenario.log.map_period_s,
                            .seed = scenario.seed});
}

RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, sim::Simulator& simulator,
                    stack::Stack& stack, const std::filesystem::path& log_mcap, RunObserver& observer) {
  return ClosedLoop(scenario, files, simulator, stack, log_mcap, observer).run(files);
}

}  // namespace patrol::app
