#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/settings.h"

namespace patrol::sim {

/// Methane leak at a site of the world.
struct LeakSettings {
  std::string at;         ///< name of a site of the world, e.g. "regulator_box_2"; sites of bodies are refused
  double rate_g_s = 1.0;  ///< mass of methane released per second
  double start_s = 0.0;   ///< time of the start of the leak

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at);
    visit("rate_g_s", self.rate_g_s, at_least(0.0));
    visit("start_s", self.start_s, at_least(0.0));
  }
};

/// Settings of the wind, which carries the gas.
struct WindSettings {
  double speed_mps = 1.5;        ///< wind speed
  double direction_deg = 240.0;  ///< direction from which the wind blows, clockwise from north (+y)
  std::string stability = "D";   ///< Pasquill stability class: A very unstable ... F stable

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_mps", self.speed_mps, between(0.2, 30.0));
    visit("direction_deg", self.direction_deg, between(-360.0, 360.0));
    visit("stability", self.stability, one_of({"A", "B", "C", "D", "E", "F"}));
  }
};

/// Returns the position of the leak, in world. Throws InputError when the world has no such site, or a body has it.
Eigen::Vector3d leak_source(const mjModel& world, const LeakSettings& leak);

/// Density of methane at 20 degC and 1 atm, kg/m3 per unit of volume fraction.
inline constexpr double kMethaneDensity_kgpm3 = 0.668;

/// Steady Gaussian plumes with reflection at the ground [Turner70, eq. 3.1].
///
/// The dispersion coefficients are Briggs' urban curves [Briggs73] of the downwind distance. They were fitted beyond
/// 100 m and are extrapolated below. The source is a puff of `kSourceSize_m`, so that the concentration at the leak is
/// finite. Buildings do not deflect the wind.
class GasPlume {
 public:
  /// Throws InputError when a leak names a site that the world does not have.
  GasPlume(const mjModel& world, const std::vector<LeakSettings>& leaks, const WindSettings& wind);
  /// Constructs the plume of one leak at `source`, in world.
  GasPlume(const Eigen::Vector3d& source, double rate_g_s, const WindSettings& wind);

  /// Returns the concentration at a point in world, kg/m3.
  double concentration_kgpm3(const Eigen::Vector3d& point, double now_s) const;

  /// Returns the integral of the volume fraction along a beam, ppm m. Sampled every 2 cm near a leak, coarser away from
  /// it.
  double column_ppm_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double length_m,
                      double now_s) const;

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
