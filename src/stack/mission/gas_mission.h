#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "stack/instruments/gas_instrument.h"
#include "stack/mission/gas_mission_settings.h"
#include "stack/mission/localization_monitor.h"
#include "stack/mission/mission.h"

namespace patrol::stack {

/// Returns the parameters of the measurement at a station.
GasRules gas_rules(const GasMissionSettings& settings);

/// Mission that visits the stations of a route in order.
///
/// At a station of type "inspect" the robot stands and measures methane (gas_instrument.h). A station that cannot be
/// reached or measured is reported and skipped. Work at a station with a time window waits until the window opens.
///
/// On a given map, the robot stands while localization is lost. A measurement during which it was lost is discarded:
/// the robot drives to the station again and repeats it.
///
/// Events: mission_started (names the stations in order), station_reached, station_late (value: seconds),
/// station_failed, localization_lost, relocalized, localization_failed, mission_completed (every station was done),
/// mission_failed.
class GasMission final : public Mission {
 public:
  /// `route_in_map`: route with its stations in order. `order_text`: a sentence for mission_started. Throws InputError
  /// if a setting is out of range or the route has no station.
  GasMission(const GasMissionSettings& settings, Route route_in_map, std::string order_text = "");

  MissionOutput step(Time now, const MissionInput& input) override;
  /// Moves the stations. The present one moves only while the robot drives to it and the shift is at least 5 cm, so
  /// that a small change interrupts neither an approach nor a measurement.
  void set_site(const Route& site_in_map) override;
  bool is_over() const override { return phase_ == Phase::kOver; }
  Event abort(Time now, EventKind kind, const std::string& text) override;
  TaskTiming timing() const override { return TaskTiming::kNext; }
  bool starts_at_survey() const override { return true; }
  void serialize_state(StateArchive& archive) override;

 private:
  enum class Phase { kWaiting, kDriving, kMeasuring, kOver };

  void wait(const MissionInput& input, MissionOutput& output);
  void drive(NavigationFeedback feedback, MissionOutput& output);
  void measure(const InspectionProgress& progress, MissionOutput& output);
  bool monitor_localization(const MissionInput& input, MissionOutput& output);
  void next_station(MissionOutput& output);
  void finish(MissionOutput& output);
  Task task() const;
  NavigationGoal goal_at(const Station& station) const;
  Event event(EventKind kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  const Station& station() const { return route_.stations[current_]; }

  GasMissionSettings settings_;
  Route route_;
  std::string order_text_;
  Phase phase_ = Phase::kWaiting;
  std::size_t current_ = 0;
  int num_failed_ = 0;
  Time phase_start_{};
  LocalizationMonitor localization_;
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::stack
