#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/grid.h"
#include "core/named_table.h"
#include "core/settings.h"
#include "localize/amcl/beam_model_settings.h"
#include "localize/amcl/confidence_settings.h"
#include "localize/amcl/divergence_monitor_settings.h"
#include "localize/amcl/global_search_settings.h"
#include "localize/amcl/kld_settings.h"
#include "localize/amcl/likelihood_field_settings.h"
#include "localize/amcl/odometry_model_settings.h"
#include "localize/amcl/pose_refinement_settings.h"
#include "localize/amcl/range_likelihood_settings.h"

namespace patrol::localize {

class LineField;
class SensorModel;
struct MonteCarloSettings;

/// Row of the table of sensor models.
using SensorModelFactory =
    NamedFactory<std::unique_ptr<SensorModel>(const MonteCarloSettings&, const OccupancyGrid&, const LineField&)>;

/// The sensor models of a scan; `make` takes the settings of its own section.
std::span<const SensorModelFactory> sensor_models();

/// Settings of the adaptive Monte Carlo localization (monte_carlo.h).
struct MonteCarloSettings {
  /// Sensor model of the particle weights (`patrol list sensor_models`).
  std::string sensor_model = "likelihood_field";
  /// Maximum effective number of independent beams of a scan, however many are evaluated: tempering of the likelihood.
  double effective_beams = 20.0;
  /// Tolerance of the mean log likelihood per beam for errors of map and model: 3 cm for a standard deviation of 0.1 m.
  double scan_fit_tolerance = 0.05;
  double update_distance_m = 0.2;  ///< distance traveled between two updates of the particles
  double update_angle_rad = 0.05;  ///< yaw change between two updates of the particles
  double update_period_s = 1.0;    ///< maximum time between two updates of the particles while the robot is lost
  /// Maximum tilt of a scan that is used, for example on a ramp; unlimited while the robot is lost.
  double max_tilt_rad = 0.1;
  /// Effective sample size, relative to the number of particles, below which the particles are resampled.
  double resample_threshold = 0.5;
  /// Minimum number of particles while the robot is lost: with fewer, hypotheses would disappear by chance.
  int min_particles_lost = 2000;
  double range_buffer_s = 2.0;     ///< maximum age of UWB ranges used in a global search
  double search_period_s = 1.0;    ///< minimum time between two global searches
  int max_logged_particles = 300;  ///< maximum number of particles in a message on /particles
  OdometryModelSettings odometry;
  LikelihoodFieldSettings likelihood_field;
  BeamModelSettings beam;
  KldSettings kld;
  RangeLikelihoodSettings ranges;
  PoseRefinementSettings scan_refinement;
  GlobalSearchSettings global_localization;
  DivergenceMonitorSettings divergence_monitor;
  ConfidenceSettings confidence;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sensor_model", self.sensor_model, one_of(sensor_models()));
    visit("effective_beams", self.effective_beams, between(1.0, 10000.0));
    visit("scan_fit_tolerance", self.scan_fit_tolerance, between(0.0, 1.0));
    visit("update_distance_m", self.update_distance_m, between(0.0, 10.0));
    visit("update_angle_rad", self.update_angle_rad, between(0.0, 3.2));
    visit("update_period_s", self.update_period_s, between(0.0, 1000.0));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
    visit("min_particles_lost", self.min_particles_lost, between(1, 1000000));
    visit("range_buffer_s", self.range_buffer_s, between(0.0, 100.0));
    visit("search_period_s", self.search_period_s, between(0.0, 1000.0));
    visit("max_logged_particles", self.max_logged_particles, between(0, 1000000));
    visit("odometry", self.odometry);
    visit("likelihood_field", self.likelihood_field);
    visit("beam", self.beam);
    visit("kld", self.kld);
    visit("ranges", self.ranges);
    visit("scan_refinement", self.scan_refinement);
    visit("global_localization", self.global_localization);
    visit("divergence_monitor", self.divergence_monitor);
    visit("confidence", self.confidence);
  }
};

}  // namespace patrol::localize
