#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct LowObstaclesSettings {
  double persistence_s = 60.0;         ///< persistence of an obstacle out of view: under the bow, next to a track
  double dynamic_persistence_s = 3.0;  ///< persistence next to a lidar obstacle, which may be a pedestrian's legs
  double sonar_persistence_s = 15.0;   ///< persistence of an obstacle detected by sonar only
  double camera_clearing_s = 2.0;      ///< age up to which ground in an image overrules sonar echoes
  int min_camera_points = 2;           ///< minimum number of points of one image in one cell
  int confirmations = 2;               ///< number of images or pings that make an obstacle

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("persistence_s", self.persistence_s, between(0.1, 3600.0));
    visit("dynamic_persistence_s", self.dynamic_persistence_s, between(0.1, 3600.0));
    visit("sonar_persistence_s", self.sonar_persistence_s, between(0.1, 3600.0));
    visit("camera_clearing_s", self.camera_clearing_s, between(0.0, 60.0));
    visit("min_camera_points", self.min_camera_points, between(1, 100));
    visit("confirmations", self.confirmations, between(1, 20));
  }
};

}  // namespace patrol::plan
