#pragma once

#include <vector>

#include "app/scenario/scenario.h"
#include "sim/simulator/simulator.h"

namespace patrol::app {

/// Actual start pose of the robot, in world.
Pose2 start_in_world(const Scenario& scenario, const ScenarioFiles& files);

/// Static obstacles of the scenario: the listed ones and the randomly scattered ones.
std::vector<sim::StaticObstacleSettings> all_static_obstacles(const Scenario& scenario);

/// Creates the simulator, with a thread of its own for expensive sensors if requested. Throws InputError if the
/// settings of the scenario are inconsistent.
sim::Simulator make_simulator(const Scenario& scenario, const ScenarioFiles& files, bool has_sensor_thread = false);

/// Throws InputError with file, line and key for a kidnap to a pose where the robot cannot stand: without ground below,
/// or in collision with the site or a static obstacle. Assembles a model for each kidnap.
void check_kidnaps(const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
