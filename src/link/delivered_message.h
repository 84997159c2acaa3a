#pragma once

#include <string>

#include "core/time.h"

namespace patrol::link {

/// Message of the simulator for a stack, as the log has it: of a sensor, or the firmware's report of a fall.
struct DeliveredMessage {
  std::string topic;
  Time log_time{};  ///< time of delivery, at most that of the turn
  std::string cdr;
};

}  // namespace patrol::link
