#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"

namespace patrol::sim {

/// Methane escaping at a site of the world.
struct LeakSettings {
  std::string at;           ///< name of the site, e.g. "regulator_box_2"
  double rate_g_s = 1.0;
  double start_s = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at);
    visit("rate_g_s", self.rate_g_s, at_least(0.0));
    visit("start_s", self.start_s, at_least(0.0));
  }
};

struct WindSettings {
  double speed_mps = 1.5;
  double direction_deg = 240.0;  ///< from which it blows, clockwise from north (+y)
  std::string stability = "D";   ///< Pasquill class: A very unstable ... F stable

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_mps", self.speed_mps, between(0.2, 30.0));
    visit("direction_deg", self.direction_deg, between(-360.0, 360.0));
    visit("stability", self.stability, one_of({"A", "B", "C", "D", "E", "F"}));
  }
};

/// Where it escapes, in world. Throws InputError when the world has no such site.
Eigen::Vector3d leak_source(const mjModel& world, const LeakSettings& leak);

/// kg/m3 of methane at 20 degC, 1 atm, per unit of volume fraction.
inline constexpr double kMethaneDensity_kgpm3 = 0.668;

/// Steady Gaussian plumes with reflection at the ground (Turner, Workbook of Atmospheric Dispersion Estimates, 1970, eq. 3.1),
/// their spread by Briggs' urban curves (1973) from the distance downwind. Those curves were fitted beyond 100 m; nearer, they are
/// extrapolated, and the source is a puff of `kSourceSize_m`, so that the concentration at the leak itself stays finite. Buildings
/// do not turn the wind.
class GasPlume {
 public:
  /// Throws InputError when a leak names a site that the world does not have.
  GasPlume(const mjModel& world, const std::vector<LeakSettings>& leaks, const WindSettings& wind);
  /// One leak at a given place.
  GasPlume(const Eigen::Vector3d& source, double rate_g_s, const WindSettings& wind);

  /// kg/m3 at a point in world.
  double concentration_kgpm3(const Eigen::Vector3d& point, double now_s) const;

  /// Integral of the volume fraction along a beam, in ppm m. Sampled every 2 cm near a leak, coarser away from it.
  double column_ppm_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double length_m, double now_s) const;

  bool is_empty() const { return leaks_.empty(); }

 private:
  struct Leak {
    Eigen::Vector3d source;
    double rate_kgps;
    double start_s;
  };
  double plume_kgpm3(const Leak& leak, const Eigen::Vector3d& point) const;

  std::vector<Leak> leaks_;
  double speed_mps_;
  Eigen::Vector2d downwind_;
  double sigma_y_slope_, sigma_z_slope_;
};

}  // namespace patrol::sim
