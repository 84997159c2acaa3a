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
#include "stack/mission/mission.h"

namespace patrol::stack {

struct GasMissionSettings {
  std::string station_order = "given";  ///< "given" or "optimized": earliest completion subject to priorities
                                      ///< and time windows
  double expected_speed_mps = 0.7;    ///< travel speed assumed for the order
  double init_wait_s = 4.0;          ///< initial standing time, for sensors to settle and biases to be estimated
  double settling_time_s = 0.5;              ///< settling time after arrival, before readings are used
  double measurement_duration_s = 3.0;             ///< duration of the readings at each station
  double measurement_timeout_s = 8.0;         ///< timeout; a station without enough readings by then is "not measured"
  int min_readings = 10;
  double alarm_column_ppm_m = 200.0;  ///< alarm threshold, equal to the column over approximately a hundred meters of
                                      ///< clean air
  double position_tolerance_m = 0.08;       ///< tolerance at a station; the route's own accuracy applies if tighter
  double yaw_tolerance_rad = 0.06;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("station_order", self.station_order, one_of({"given", "optimized"}));
    visit("expected_speed_mps", self.expected_speed_mps, between(0.01, 10.0));
    visit("init_wait_s", self.init_wait_s, between(0.0, 600.0));
    visit("settling_time_s", self.settling_time_s, between(0.0, 60.0));
    visit("measurement_duration_s", self.measurement_duration_s, between(0.0, 600.0));
    visit("measurement_timeout_s", self.measurement_timeout_s, between(0.1, 600.0));
    visit("min_readings", self.min_readings, between(1, 100000));
    visit("alarm_column_ppm_m", self.alarm_column_ppm_m, at_least(0.0));
    visit("position_tolerance_m", self.position_tolerance_m, between(0.005, 5.0));
    visit("yaw_tolerance_rad", self.yaw_tolerance_rad, between(0.005, 3.2));
  }
};

/// Returns the parameters of the measurement at a station.
GasRules gas_rules(const GasMissionSettings& settings);

/// Mission that visits the stations of a route in order.
///
/// At a station of type "inspect" the robot stands and measures methane (gas_instrument.h). A station that cannot be
/// reached or measured is reported and skipped. Work at a station with a time window waits until the window opens.
///
/// Events: mission_started (names the stations in order), station_reached, station_late (value: seconds),
/// station_failed, mission_completed (every station was done), mission_failed.
class GasMission final : public Mission {
 public:
  /// `route_in_map`: route with its stations in order. `order_text`: a sentence for mission_started. Throws InputError
  /// if a setting is out of range or the route has no station.
  GasMission(const GasMissionSettings& settings, Route route_in_map, std::string order_text = "");

  MissionOutput step(Time now, const MissionInput& input) override;
  bool is_over() const override { return phase_ == Phase::kOver; }
  Event abort(Time now, EventKind kind, const std::string& text) override;
  TaskTiming timing() const override { return TaskTiming::kNext; }
  bool starts_at_survey() const override { return true; }

 private:
  enum class Phase { kWaiting, kDriving, kMeasuring, kOver };

  void wait(MissionOutput& output);
  void drive(NavigationFeedback feedback, MissionOutput& output);
  void measure(const InspectionProgress& progress, MissionOutput& output);
  void next_station(MissionOutput& output);
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
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::stack
