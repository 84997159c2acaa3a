#pragma once

#include "core/settings.h"
#include "localize/legged_odometry_settings.h"
#include "localize/track_odometry_settings.h"

namespace patrol::stack {

struct OdometrySettings {
  localize::LeggedOdometrySettings legged;  ///< robot with legs
  localize::TrackOdometrySettings tracked;  ///< robot with tracks

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("legged", self.legged);
    visit("tracked", self.tracked);
  }
};

}  // namespace patrol::stack
