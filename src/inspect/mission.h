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
#include "inspect/gas_measurement.h"
#include "inspect/navigation_feedback.h"

namespace patrol::inspect {

struct MissionSettings {
  std::string order = "given";        ///< of the stations; or "best": the soonest done, by priorities and windows
  double expected_speed_mps = 0.7;    ///< on the way, for that
  double start_wait_s = 4.0;          ///< standing still at first: sensors settle, their biases are learnt
  double settle_s = 0.5;              ///< after arriving, before the instrument is believed
  double measure_s = 3.0;             ///< of readings at each station
  double max_measure_s = 8.0;         ///< then a station without enough readings is "not measured"
  int min_readings = 10;
  double alarm_column_ppm_m = 200.0;  ///< methane beyond it is a leak: a hundred metres of clean air
  double position_tol_m = 0.08;       ///< at a station; never more than the route's own accuracy asks
  double yaw_tol_rad = 0.06;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("order", self.order, one_of({"given", "best"}));
    visit("expected_speed_mps", self.expected_speed_mps, between(0.01, 10.0));
    visit("start_wait_s", self.start_wait_s, between(0.0, 600.0));
    visit("settle_s", self.settle_s, between(0.0, 60.0));
    visit("measure_s", self.measure_s, between(0.0, 600.0));
    visit("max_measure_s", self.max_measure_s, between(0.1, 600.0));
    visit("min_readings", self.min_readings, between(1, 100000));
    visit("alarm_column_ppm_m", self.alarm_column_ppm_m, at_least(0.0));
    visit("position_tol_m", self.position_tol_m, between(0.005, 5.0));
    visit("yaw_tol_rad", self.yaw_tol_rad, between(0.005, 3.2));
  }
};

struct MissionOutput {
  std::optional<NavigationGoal> goal;  ///< none: stand
  std::vector<Event> events;           ///< that happened now
};

/// Walks the route station by station: goes there, stands, measures methane, raises the alarm where the column exceeds the
/// threshold beyond doubt (two standard errors), and goes on. A station that cannot be reached or measured is reported and left out.
///
/// Work at a station with a window waits for it to open.
///
/// Events: mission_started (names the stations in their order), station_reached, station_late (value: by how many seconds), gas_measured (value: column, ppm m), alarm (value: column; target: the place on the beam
/// nearest to what was inspected), station_failed, mission_completed (every station was done), mission_failed.
class Mission {
 public:
  /// `route_in_map`: its stations in their order. `T_body_gas`: the methane meter, looking along its x axis. `about_order`: a sentence for mission_started. Throws InputError if a setting breaks its rule.
  Mission(const MissionSettings& settings, Route route_in_map, const Pose3& T_body_gas, std::string about_order = "");

  MissionOutput step(Time now, const PoseEstimate& pose, NavigationFeedback feedback,
                     const std::optional<GasReading>& newest_gas);

  bool is_over() const { return phase_ == Phase::kOver; }
  /// Ends the mission with an event of this kind, unless it is over.
  Event abort(Time now, const std::string& kind, const std::string& text);

 private:
  enum class Phase { kWaiting, kDriving, kMeasuring, kOver };

  void wait(MissionOutput& output);
  void drive(NavigationFeedback feedback, MissionOutput& output);
  void measure(const std::optional<GasReading>& newest_gas, MissionOutput& output);
  void report_gas(MissionOutput& output);
  Eigen::Vector2d place_on_beam() const;
  void next_station(MissionOutput& output);
  NavigationGoal goal_at(const Station& station) const;
  Event event(const std::string& kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  const Station& station() const { return route_.stations[current_]; }

  MissionSettings settings_;
  Route route_;
  Pose3 T_body_gas_;
  std::string about_order_;
  Phase phase_ = Phase::kWaiting;
  std::size_t current_ = 0;
  int num_failed_ = 0;
  Time phase_start_{};
  GasMeasurement gas_;
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::inspect
