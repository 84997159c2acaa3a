#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"

/// Sensors that a scenario needs: the firmware, the parts of the built-in stack, the mission, faults, and sensors that
/// the scenario enables by name. An external stack needs none. Any other sensor is absent on a robot without its frame.
namespace patrol::app {

/// Returns the sensors that a scenario needs, each with all its reasons, in the order of the reasons.
std::vector<SensorNeed> sensor_needs(const Scenario& scenario, const ScenarioFiles& files);

/// Returns the sensors that the firmware of a robot needs.
std::vector<SensorNeed> firmware_needs(const RobotDescription& robot);

/// Throws InputError with the location and all sensors that the robot lacks, if it lacks any. `robot_name`: folder in
/// `models`.
void require_sensors(const std::vector<SensorNeed>& needs, const RobotDescription& robot, const std::string& robot_name,
                     const std::string& location);

/// Disables the sensors for which the robot has no frame. Those of `enabled_by_name` stay enabled and are added to
/// `scenario.requested`.
void disable_absent_sensors(const RobotDescription& robot, const std::vector<std::string>& enabled_by_name,
                            Scenario& scenario);

/// Returns the enabled sensors for which the robot has no frame.
std::vector<std::string> absent_sensors(const RobotDescription& robot, const sim::SensorSuiteSettings& sensors);

}  // namespace patrol::app
