#pragma once

#include <vector>

#include "core/sensors/registry.h"

namespace patrol::sim {

/// Messages in transit from the sensors to the stack, in order of delivery. Messages due at the same instant keep their
/// order of insertion.
class DeliveryQueue {
 public:
  void push(Time due, SensorMessage message);

  /// Removes and returns the messages due by `now`.
  std::vector<SensorMessage> take_due(Time now);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(queue_);
  }

 private:
  struct Delivery {
    Time due;
    SensorMessage message;
  };
  std::vector<Delivery> queue_;
};

}  // namespace patrol::sim
