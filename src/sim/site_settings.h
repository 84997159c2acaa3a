#pragma once

#include <string>
#include <vector>

#include "core/settings.h"

namespace patrol::sim {

/// Geoms of a site, by pattern. A pattern matches the whole name; `*` stands for any text.
struct GeomPatterns {
  std::vector<std::string> geoms = {};      ///< patterns of names of geoms
  std::vector<std::string> materials = {};  ///< patterns of names of materials
  std::vector<std::string> groups = {};     ///< geom groups, 0 to 5

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("geoms", self.geoms);
    visit("materials", self.materials);
    visit("groups", self.groups, one_of({"0", "1", "2", "3", "4", "5"}));
  }
};

/// Rules for the ground of a site: contacts with it are driving or walking, all others are collisions. A contact with a
/// static geom is also one with the ground if it is from above (normal within 45 degrees of the vertical) and at most
/// `max_step_m` higher than the robot's lowest contact, or if the geom's top is at most `max_curb_m` higher.
struct GroundSettings {
  GeomPatterns all = {};     ///< geoms that are ground, also at their sides
  GeomPatterns curbs = {};   ///< geoms that are ground from above, and at their sides up to `max_curb_m`
  double max_curb_m = 0.15;  ///< maximum height of a curb's top above the robot's lowest contact
  double max_step_m = 0.25;  ///< maximum height above the robot's lowest contact; 0: only the patterns decide

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("all", self.all);
    visit("curbs", self.curbs);
    visit("max_curb_m", self.max_curb_m, between(0.0, 1.0));
    visit("max_step_m", self.max_step_m, between(0.0, 1.0));
  }
};

/// Settings of a site, worlds/NAME/NAME.yaml.
struct SiteSettings {
  GroundSettings ground;  ///< rules for the ground

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ground", self.ground);
  }
};

}  // namespace patrol::sim
