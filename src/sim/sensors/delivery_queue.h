#pragma once

#include <vector>

#include "core/sensors/registry.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {

/// Message in transit.
struct QueuedMessage {
  SensorMessage message;
  Sensor* incomplete = nullptr;  ///< sensor that still has to complete the message

  /// Only complete messages can be saved.
  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(message);
  }
};

/// Messages in transit from the sensors to the stack, in order of delivery. Messages due at the same instant keep their
/// order of insertion.
class DeliveryQueue {
 public:
  void push(Time due, QueuedMessage message);

  /// Calls `visit` with every message, in order of delivery.
  template <typename Visit>
  void for_each(Visit&& visit) {
    for (Delivery& delivery : queue_) visit(delivery.queued);
  }

  /// Removes and returns the messages due by `now`.
  std::vector<QueuedMessage> take_due(Time now);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(queue_);
  }

 private:
  struct Delivery {
    Time due;
    QueuedMessage queued;
  };
  std::vector<Delivery> queue_;
};

}  // namespace patrol::sim
