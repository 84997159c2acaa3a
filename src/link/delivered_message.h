#pragma once

#include <cstddef>
#include <string>

#include "core/time.h"

namespace patrol::link {

/// Message of the simulator for a stack, as the log has it: of a sensor, or the firmware's report of a fall.
struct DeliveredMessage {
  std::string topic;
  Time log_time{};  ///< time of delivery, at most that of the turn
  std::string cdr;
};

/// Size of messages from which a stack gets them before its turn, so that it processes a scan or an image while the
/// simulator continues.
inline constexpr std::size_t kEarlyBytes = std::size_t{8} << 10;

}  // namespace patrol::link
