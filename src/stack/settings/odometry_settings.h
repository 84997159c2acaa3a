#pragma once

#include "core/settings.h"
#include "localize/legged_odometry_settings.h"
#include "localize/track_odometry_settings.h"

namespace patrol::stack {

/// Returns the settings of the odometry of a robot on wheels: wheel encoders of 16384 counts, and tires on hard ground,
/// which slip less than tracks on rock.
inline localize::TrackOdometrySettings wheel_odometry_defaults() {
  localize::TrackOdometrySettings settings;
  settings.ticks_per_sprocket_turn = 16384.0;
  settings.skid_ratio = 0.0;
  return settings;
}

struct OdometrySettings {
  localize::LeggedOdometrySettings legged;  ///< robot with legs
  localize::TrackOdometrySettings tracked;  ///< robot with tracks
  /// Robot with wheels.
  localize::TrackOdometrySettings wheeled = wheel_odometry_defaults();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("legged", self.legged);
    visit("tracked", self.tracked);
    visit("wheeled", self.wheeled);
  }
};

}  // namespace patrol::stack
