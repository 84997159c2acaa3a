#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "stack/instruments/instrument.h"

namespace patrol::stack {

/// Instruments of the robot. Passes each order to the instrument of its kind.
class InstrumentSet {
 public:
  InstrumentSet(std::vector<std::unique_ptr<Instrument>> instruments, double siren_duration_s);

  void add(const SensorMessage& message, const StationPoseLookup& station_pose_at);
  /// Executes `order` for a control period. A new order starts at once; nullopt ends the previous one. An order for an
  /// instrument that the robot does not have fails.
  InspectionProgress step(Time now, const std::optional<InspectionOrder>& order, const StationPose& station_pose,
                          StackOutput& output);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive.in_place(instruments_);
    archive(light_, order_);
  }

 private:
  Instrument* find(InstrumentKind kind) const;

  std::vector<std::unique_ptr<Instrument>> instruments_;
  WarningLight light_;
  std::optional<InspectionOrder> order_;
};

}  // namespace patrol::stack
