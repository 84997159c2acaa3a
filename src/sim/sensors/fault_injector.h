#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "sim/sensors/fault.h"

namespace patrol::sim {

/// Status of a fault declared by a scenario.
struct FaultStatus {
  FaultSettings fault;
  bool was_triggered = false;  ///< true: at least one message was changed
};

/// Applies the faults of a scenario to sensor messages. Random faults draw by the number of the sensor's message, from
/// a stream of their own: no fault changes the draws of another one.
class FaultInjector {
 public:
  FaultInjector(const std::vector<FaultSettings>& faults, std::uint64_t seed);

  /// Changes a message that is complete at `ready` and due at `due`. Returns false when the message is lost.
  bool apply(Time ready, Time& due, SensorMessage& message);

  /// Keeps a message that was incomplete in `apply`.
  void remember(const SensorMessage& message) { last_good_[message.index()] = message; }

  const std::vector<FaultStatus>& reports() const { return reports_; }

  /// Saves or restores the state. Faults that the other run does not have are not restored.
  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_good_, num_messages_);
    std::vector<FaultStatus> stored = reports_;
    archive(stored);
    for (const FaultStatus& status : stored) set_triggered(status);
  }

 private:
  bool has_fault(std::string_view sensor) const;
  void set_triggered(const FaultStatus& status);
  bool change(std::size_t index, std::uint64_t number, Time ready, Time& due, SensorMessage& message);

  std::vector<FaultStatus> reports_;
  std::vector<RandomStream> draws_;  ///< [fault]
  /// [type of the message], last message before a freeze; kept without faults as well, so that a branch may begin one;
  /// a panoramic scan, which is large, only with a fault of the scanner
  std::array<std::optional<SensorMessage>, std::variant_size_v<SensorMessage>> last_good_;
  std::array<std::uint64_t, std::variant_size_v<SensorMessage>> num_messages_{};  ///< [type of the message]
};

}  // namespace patrol::sim
