#pragma once

#include "core/settings.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/water/water_settings.h"

namespace patrol::stack {

/// Settings of the tunnel instruments: panoramic scanner, siren, and the evaluation of lining and water.
struct InspectionSettings {
  double scan_settle_s = 4.0;      ///< settling time before a panoramic scan; a robot on springs oscillates after
                                   ///< stopping
  double scan_patience_s = 600.0;  ///< timeout of a panoramic scan
  double siren_s = 10.0;           ///< duration of the siren at an alarm; the light stays on
  inspect::LiningSettings lining;
  inspect::WaterSettings water;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scan_settle_s", self.scan_settle_s, between(0.0, 60.0));
    visit("scan_patience_s", self.scan_patience_s, between(1.0, 3600.0));
    visit("siren_s", self.siren_s, between(0.0, 600.0));
    visit("lining", self.lining);
    visit("water", self.water);
  }
};

}  // namespace patrol::stack
