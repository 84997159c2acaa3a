#pragma once

#include "core/settings.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/water/water_settings.h"

namespace patrol::stack {

/// Settings of the tunnel instruments: panoramic scanner, siren, and the evaluation of lining and water.
struct InspectionSettings {
  double scan_settling_time_s = 4.0;  ///< settling time before a panoramic scan; a robot on springs oscillates after
                                      ///< stopping
  double scan_timeout_s = 600.0;      ///< timeout of a panoramic scan
  double siren_duration_s = 10.0;     ///< duration of the siren at an alarm; the light stays on
  inspect::LiningSettings lining;
  inspect::WaterSettings water;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scan_settling_time_s", self.scan_settling_time_s, between(0.0, 60.0));
    visit("scan_timeout_s", self.scan_timeout_s, between(1.0, 3600.0));
    visit("siren_duration_s", self.siren_duration_s, between(0.0, 600.0));
    visit("lining", self.lining);
    visit("water", self.water);
  }
};

}  // namespace patrol::stack
