#pragma once

#include <string>
#include <vector>

#include "core/route.h"
#include "core/settings.h"

namespace patrol::app {

/// Pose in the frame `site`.
struct PlanarPoseSettings {
  double x_m = 0.0;          ///< x in the site
  double y_m = 0.0;          ///< y in the site
  double heading_deg = 0.0;  ///< heading in the site, counterclockwise from x

  Pose2 pose() const;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("heading_deg", self.heading_deg, between(-360.0, 360.0));
  }
};

/// Station of a tour.
struct TourStationSettings {
  std::string name = {};      ///< name of the station; empty: "station_" and its number
  std::string type = "pass";  ///< task: pass, or home, which ends the mission
  double x_m = 0.0;           ///< x in the site
  double y_m = 0.0;           ///< y in the site
  double heading_deg = 0.0;   ///< heading of the robot in the site, counterclockwise from x
  double accuracy_m = 0.3;    ///< position tolerance

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("name", self.name);
    visit("type", self.type, one_of({"pass", "home"}));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("heading_deg", self.heading_deg, between(-360.0, 360.0));
    visit("accuracy_m", self.accuracy_m, between(0.01, 100.0));
  }
};

/// Mission given in the scenario instead of in a file. The last station ends the mission.
struct TourSettings {
  PlanarPoseSettings start = {};                   ///< surveyed start
  std::vector<TourStationSettings> stations = {};  ///< stations in their order; empty: no tour

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("start", self.start);
    visit("stations", self.stations);
  }
};

/// Returns the stations of a tour; the last one is of type home.
Route route_of(const TourSettings& tour);

/// Returns the text "X,Y" or "X,Y,DEG" as a pose; without a heading, that from `from` to it. Throws InputError with the
/// option.
PlanarPoseSettings parse_pose(const std::string& text, const char* option, const PlanarPoseSettings& from);

/// Returns the overrides of a scenario (`path=value`) that set a tour from the start through the goals, and no mission
/// file.
std::vector<std::string> overrides_of(const TourSettings& tour);

}  // namespace patrol::app
