#pragma once

#include <functional>
#include <optional>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"
#include "stack/instruments/inspection_order.h"
#include "stack/instruments/station_pose.h"
#include "stack/instruments/warning_light.h"

namespace patrol::stack {

/// Function that returns the body pose at a recent instant; none outside the time span of odometry.
using StationPoseLookup = std::function<std::optional<StationPose>(Time)>;

/// State of the robot in a control period, and the outputs available to an instrument.
struct InspectionContext {
  Time now{};
  StationPose station_pose;
  StackOutput& output;
  WarningLight& light;

  /// Publishes an event of this control period.
  void publish_event(EventKind kind, const std::string& subject, const std::string& text, double value,
                     const Eigen::Vector2d& p_map) const {
    output.publish(Event{.stamp = now,
                         .kind = kind,
                         .subject = subject,
                         .text = text,
                         .value = value,
                         .T_map_body = station_pose.T_map_body,
                         .p_map_target = p_map});
  }
};

/// Interface of an inspection instrument with its evaluation. It executes one order after another.
class Instrument {
 public:
  virtual ~Instrument() = default;

  virtual InstrumentKind kind() const = 0;
  /// Processes a sensor message; called for all types, of which an instrument ignores those that it does not use.
  virtual void add(const SensorMessage& message, const StationPoseLookup& station_pose_at) = 0;
  /// Starts an order and discards the previous one.
  virtual void begin(const InspectionOrder& order, Time now) = 0;
  /// Executes the order. Called once per control period while there is one.
  virtual InspectionProgress step(const InspectionContext& context) = 0;
  /// Ends the order, complete or not.
  virtual void end() {}

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

}  // namespace patrol::stack
