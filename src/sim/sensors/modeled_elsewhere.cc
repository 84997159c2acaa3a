#include "sim/sensors/sensor.h"

/// Sensors that other parts of the simulation model, and that reach the stack by SensorSuite::add.
namespace patrol::sim {

/// Modeled by RemoteOperator.
template <>
std::unique_ptr<Sensor> make_sensor<RemoteCommand>(const SensorContext&) {
  return nullptr;
}

/// Modeled by AntennaMount.
template <>
std::unique_ptr<Sensor> make_sensor<AntennaState>(const SensorContext&) {
  return nullptr;
}

}  // namespace patrol::sim
