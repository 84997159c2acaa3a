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

/// Applies the faults of a scenario to sensor messages.
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
    archive(last_good_, outlier_count_, jitter_count_);
    std::vector<FaultStatus> stored = reports_;
    archive(stored);
    for (const FaultStatus& status : stored) set_triggered(status);
  }

 private:
  bool has_fault(std::string_view sensor) const;
  void set_triggered(const FaultStatus& status);
  bool change(FaultStatus& report, Time ready, Time& due, SensorMessage& message);

  std::vector<FaultStatus> reports_;
  /// [type of the message], last message before a freeze; kept without faults as well, so that a branch may begin one;
  /// a panoramic scan, which is large, only with a fault of the scanner
  std::array<std::optional<SensorMessage>, std::variant_size_v<SensorMessage>> last_good_;
  RandomStream outliers_, jitter_;
  std::uint64_t outlier_count_ = 0, jitter_count_ = 0;
};

}  // namespace patrol::sim
