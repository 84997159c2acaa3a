#pragma once

#include <string>

#include "core/settings.h"

namespace patrol::stack {

struct GasMissionSettings {
  /// Order of the stations: "given", or "optimized" for the earliest completion subject to priorities and time windows.
  std::string station_order = "given";
  double expected_speed_mps = 0.7;      ///< travel speed assumed for the order
  double init_wait_s = 4.0;             ///< initial standing time, for sensors to settle and biases to be estimated
  double settling_time_s = 0.5;         ///< settling time after arrival, before readings are used
  double measurement_duration_s = 3.0;  ///< duration of the readings at each station
  double measurement_timeout_s = 8.0;   ///< timeout; a station without enough readings by then is "not measured"
  int min_readings = 10;                ///< minimum number of gas readings of a measurement
  double alarm_column_ppm_m = 200.0;    ///< alarm threshold, equal to the column over approximately a hundred meters of
                                        ///< clean air
  double position_tolerance_m = 0.08;   ///< tolerance at a station; the route's own accuracy applies if tighter
  double yaw_tolerance_rad = 0.06;      ///< maximum heading error of the robot at a station; 3 or more: any heading
  double relocalization_timeout_s = 30.0;  ///< relocalization timeout; the robot stands still meanwhile

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
    visit("relocalization_timeout_s", self.relocalization_timeout_s, between(1.0, 600.0));
  }
};

}  // namespace patrol::stack
