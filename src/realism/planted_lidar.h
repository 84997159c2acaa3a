#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "realism/lidar_fit.h"

namespace patrol::realism {

/// Test of the fit on a simulated log whose lidar is known.
struct PlantedTrialSettings {
  int scans = 60;
  int beams = 720;
  /// Errors of the path that the fit is given, standard deviations; the scans are then aligned to the site.
  double path_std_m = 0.0;
  double path_yaw_std_deg = 0.0;
  /// Whether the walls are without openings, dark surfaces and obstacles: several parameters are not observable there.
  bool is_plain_room = false;
};

struct PlantedTrial {
  LidarDevice planted;                                 ///< the lidar of the log
  std::vector<std::pair<std::string, double>> values;  ///< values of the planted parameters, by their names in the fit
  LidarFit fit;
};

/// Returns a site of five rooms with doors, posts, boxes and surfaces of 4 to 80 % reflectivity, 26 m by 16 m; or one
/// room without anything.
Site planted_site(bool is_plain_room);

/// Draws fourteen parameters of a lidar, simulates scans at drawn poses and fits the parameters to them.
PlantedTrial run_planted_trial(const Site& site, const PlantedTrialSettings& settings, std::uint64_t seed);

}  // namespace patrol::realism
