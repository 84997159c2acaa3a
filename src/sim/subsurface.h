#pragma once

#include <string>
#include <vector>

#include "core/settings.h"

namespace patrol::sim {

/// Cave or karst conduit filled with water or mud, in world.
struct WaterBodySettings {
  double x_m = 0.0;       ///< x of the center in the world
  double y_m = 0.0;       ///< y of the center in the world
  double z_m = 0.0;       ///< z of the center in the world
  double radius_m = 6.0;  ///< radius of the sphere of equal volume
  /// Conductivity of the water; fresh karst water: 0.05; mud and mineralized water: 0.3 to 1.
  double conductivity_spm = 0.6;
  /// Standard deviation of the logarithm of the conductivity over seeds; the conductivity above is its median.
  double conductivity_log_std = 0.0;
  std::string shape = "sphere";      ///< shape of the body: "sphere", or "spheroid" with the keys below
  double aspect_ratio = 1.0;         ///< semi-axis along the axis of symmetry, relative to the one across it
  double axis_azimuth_deg = 0.0;     ///< azimuth of the axis of symmetry
  double axis_elevation_deg = 90.0;  ///< elevation of the axis of symmetry; 90: vertical

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("z_m", self.z_m);
    visit("radius_m", self.radius_m, between(0.5, 30.0));
    visit("conductivity_spm", self.conductivity_spm, between(0.01, 5.0));
    visit("conductivity_log_std", self.conductivity_log_std, between(0.0, 1.0));
    visit("shape", self.shape, one_of({"sphere", "spheroid"}));
    visit("aspect_ratio", self.aspect_ratio, between(1.0 / 3.0, 3.0));
    visit("axis_azimuth_deg", self.axis_azimuth_deg, between(-360.0, 360.0));
    visit("axis_elevation_deg", self.axis_elevation_deg, between(-90.0, 90.0));
  }
};

/// Wet fault zone: a plane layer, thin compared with its distance from the coil.
struct FaultZoneSettings {
  /// Excess conductivity over that of the rock, times thickness, in S; 0: no fault zone. 2 m of 0.01 S/m in rock of
  /// 0.003 S/m: 0.014.
  double conductance_s = 0.0;
  double x_m = 0.0;                   ///< x of a point of the plane in the world
  double y_m = 0.0;                   ///< y of a point of the plane in the world
  double z_m = 0.0;                   ///< z of a point of the plane in the world
  double normal_azimuth_deg = 0.0;    ///< azimuth of the normal of the plane
  double normal_elevation_deg = 0.0;  ///< elevation of the normal of the plane

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("conductance_s", self.conductance_s, between(0.0, 10.0));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("z_m", self.z_m);
    visit("normal_azimuth_deg", self.normal_azimuth_deg, between(-360.0, 360.0));
    visit("normal_elevation_deg", self.normal_elevation_deg, between(-90.0, 90.0));
  }
};

/// Settings of the rock ahead of the tunnel face: its conductivity, the air of the tunnel and a fault zone.
struct RockSettings {
  double conductivity_spm = 0.003;  ///< conductivity of the rock; limestone: 0.0005 to 0.005
  /// Standard deviation of the logarithm of the conductivity over seeds; the conductivity above is its median.
  double conductivity_log_std = 0.0;
  double tunnel_radius_m = 0.0;     ///< radius of the tunnel around the coil; 0: no air
  double tunnel_azimuth_deg = 0.0;  ///< direction of the tunnel axis at the coil
  /// Fraction of the effect of an infinite tunnel: 0.5 for a coil at the face, 1 for one far from it.
  double tunnel_air_fraction = 1.0;
  FaultZoneSettings fault_zone = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("conductivity_spm", self.conductivity_spm, between(1e-4, 0.1));
    visit("conductivity_log_std", self.conductivity_log_std, between(0.0, 1.0));
    visit("tunnel_radius_m", self.tunnel_radius_m, between(0.0, 10.0));
    visit("tunnel_azimuth_deg", self.tunnel_azimuth_deg, between(-360.0, 360.0));
    visit("tunnel_air_fraction", self.tunnel_air_fraction, between(0.0, 1.0));
    visit("fault_zone", self.fault_zone);
  }
};

/// Subsurface ahead of the tunnel face.
struct Subsurface {
  RockSettings rock = {};
  std::vector<WaterBodySettings> water_bodies = {};
};

}  // namespace patrol::sim
