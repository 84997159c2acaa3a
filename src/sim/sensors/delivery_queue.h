#pragma once

#include <vector>

#include "core/sensors/registry.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {

/// Message in transit.
struct QueuedMessage {
  SensorMessage message;
  Sensor* incomplete = nullptr;  ///< sensor that still has to complete the message
};

/// Messages in transit from the sensors to the stack, in order of delivery. Messages due at the same instant keep their
/// order of insertion.
class DeliveryQueue {
 public:
  void push(Time due, QueuedMessage message);

  /// Removes and returns the messages due by `now`.
  std::vector<QueuedMessage> take_due(Time now);

 private:
  struct Delivery {
    Time due;
    QueuedMessage queued;
  };
  std::vector<Delivery> queue_;
};

}  // namespace patrol::sim
