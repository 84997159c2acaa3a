#include "sim/sensors/sensor.h"

/// Sensors that are modeled by other components and reach the stack through SensorSuite::add.
namespace patrol::sim {

/// TeleopOperator models the teleoperation commands.
template <>
std::unique_ptr<Sensor> make_sensor<TeleopCommand>(const SensorContext&) {
  return nullptr;
}

/// AntennaMount models the antenna's servos.
template <>
std::unique_ptr<Sensor> make_sensor<AntennaState>(const SensorContext&) {
  return nullptr;
}

}  // namespace patrol::sim
