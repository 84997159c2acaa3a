#pragma once

#include <vector>

#include "core/sensors/registry.h"

namespace patrol::sim {

/// Messages on their way from the sensors to the stack, in order of delivery; messages due at the same instant keep
/// the order in which they were put in.
class DeliveryQueue {
 public:
  void push(Time due, SensorMessage message);

  /// Removes and returns the messages due by `now`.
  std::vector<SensorMessage> take_due(Time now);

 private:
  struct Delivery {
    Time due;
    SensorMessage message;
  };
  std::vector<Delivery> queue_;
};

}  // namespace patrol::sim
