#pragma once

#include <string>

namespace patrol::stack {

/// Change of the state of a sensor: fault or recovery.
struct SensorChange {
  std::string sensor;
  bool has_recovered = false;
  std::string text;  ///< one sentence for a person
};

}  // namespace patrol::stack
