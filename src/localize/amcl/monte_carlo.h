#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/named_table.h"
#include "core/random.h"
#include "core/settings.h"
#include "core/uwb.h"
#include "localize/amcl/beam_model.h"
#include "localize/amcl/fit_monitor.h"
#include "localize/amcl/global_search.h"
#include "localize/amcl/kld.h"
#include "localize/amcl/likelihood_field.h"
#include "localize/amcl/line_field.h"
#include "localize/amcl/odometry_model.h"
#include "localize/amcl/particle_cloud.h"
#include "localize/amcl/pose_refinement.h"
#include "localize/amcl/range_likelihood.h"
#include "localize/amcl/range_memory.h"
#include "localize/amcl/sensor_model.h"
#include "localize/amcl/trust.h"

namespace patrol::localize {

struct MonteCarloSettings;

/// The sensor models of a scan; `make` takes the settings of its own section.
std::span<const NamedFactory<std::unique_ptr<SensorModel>(const MonteCarloSettings&, const OccupancyGrid&, const LineField&)>> sensor_models();

struct MonteCarloSettings {
  std::string sensor_model = "likelihood_field";
  double independent_beams = 20.0;     ///< a scan says as much as so many beams that err independently; more beams only average
  double scan_fit_tol = 0.05;          ///< mean log-likelihood of a beam by which maps and models err: 3 cm at a deviation of 0.1 m
  double update_distance_m = 0.2;      ///< particles are weighed after so much way,
  double update_angle_rad = 0.05;      ///< or such a turn,
  double update_period_s = 1.0;        ///< or, as long as the robot is lost, after this time
  double max_tilt_rad = 0.1;           ///< a scan tilted by more, on a ramp, says nothing to a robot that knows where it is
  double resample_threshold = 0.5;     ///< resample when the effective sample size falls below this share of the particles
  int min_particles_when_lost = 2000;  ///< few particles forget one possible place after the other by chance
  double range_memory_s = 2.0;         ///< ranges this old are still used to search with
  double search_period_s = 1.0;        ///< at most one global search in this time
  int max_logged_particles = 300;
  OdometryModelSettings odometry;
  LikelihoodFieldSettings likelihood_field;
  BeamModelSettings beam;
  KldSettings kld;
  RangeLikelihoodSettings ranges;
  PoseRefinementSettings refinement;
  GlobalSearchSettings search;
  FitMonitorSettings fit;
  TrustSettings trust;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sensor_model", self.sensor_model, one_of(sensor_models()));
    visit("independent_beams", self.independent_beams, between(1.0, 10000.0));
    visit("scan_fit_tol", self.scan_fit_tol, between(0.0, 1.0));
    visit("update_distance_m", self.update_distance_m, between(0.0, 10.0));
    visit("update_angle_rad", self.update_angle_rad, between(0.0, 3.2));
    visit("update_period_s", self.update_period_s, between(0.0, 1000.0));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
    visit("min_particles_when_lost", self.min_particles_when_lost, between(1, 1000000));
    visit("range_memory_s", self.range_memory_s, between(0.0, 100.0));
    visit("search_period_s", self.search_period_s, between(0.0, 1000.0));
    visit("max_logged_particles", self.max_logged_particles, between(0, 1000000));
    visit("odometry", self.odometry);
    visit("likelihood_field", self.likelihood_field);
    visit("beam", self.beam);
    visit("kld", self.kld);
    visit("ranges", self.ranges);
    visit("refinement", self.refinement);
    visit("search", self.search);
    visit("fit", self.fit);
    visit("trust", self.trust);
  }
};

struct LocalizationUpdate {
  PoseEstimate estimate;
  LocalizationTrust trust;
  bool is_weighed = false;     ///< the particles were; otherwise the pose was only carried on and the scan laid on the map
  std::optional<ParticleSet> particles;  ///< if they were weighed: every so many of them, for the log
  int num_particles = 0;       ///< that there are now
  int num_injected = 0;        ///< of these, put where a global search found room for hope
  double clump_weight = 0.0;   ///< share of the belief behind the estimate
  double matched_share = 0.0;  ///< of the scan's points on the map's surfaces
};

/// Adaptive Monte-Carlo localisation on a map that is known (Thrun, Burgard, Fox, Probabilistic Robotics, 2005, chapter 8; KLD
/// sampling: Fox, IJRR 2003), with UWB ranges as weights and not as positions.
///
///   every scan      carry the belief on by odometry -> lay the scan on the map -> pose, covariance, trust
///   after some way  move particles -> weigh by ranges -> weigh by scan -> lay the scan on the map -> resample, inject
///
/// Particles carry what has more than one summit: the start, a kidnap, both directions of a tunnel. The pose itself
/// is the Gaussian posterior of the heaviest clump of particles, as it was before the scan, and the scan
/// (pose_refinement.h): millimetres where the map tells the place, and the particles' own width where it does not.
class MonteCarloLocalizer {
 public:
  /// Anchors in map, their heights above the body's origin: the ground is taken to be level. Throws InputError if a setting breaks its rule, or the map is empty or has no free or no occupied cell.
  MonteCarloLocalizer(const MonteCarloSettings& settings, const OccupancyGrid& map, const std::vector<UwbAnchor>& anchors_in_map,
                      const Pose3& T_body_uwb, std::uint64_t seed);

  /// The body is near `T_map_body`; covariance of x, y, yaw in map.
  void start_at(const Pose2& T_map_body, const Eigen::Matrix3d& covariance);
  /// The body may be anywhere on the map: the next scan is looked for everywhere.
  void start_anywhere();

  /// `T_odom_body` at the range's stamp. Ranges of anchors that the survey does not know are ignored, and so are those that are
  /// not finite and positive. The newest of each anchor is weighed with the next scan that is.
  void add(const UwbRange& range, const Pose3& T_odom_body) { ranges_.add(range, T_odom_body); }
  /// `T_odom_body` at the scan's stamp.
  LocalizationUpdate update(const LevelScan& seen, const Pose2& T_odom_body);

  const ParticleCloud& particles() const { return cloud_; }

 private:
  void start_from(const LevelScan& scan, const Pose2& T_odom_body);
  bool is_due(const Pose2& T_before_now, Time stamp) const;
  void judge_ranges(const std::vector<AnchoredRange>& ranges, const slam::PoseGaussian& belief);
  RefinedPose weigh(const LevelScan& scan, const std::vector<AnchoredRange>& ranges);
  int resample_and_inject(const LevelScan& scan, const Pose2& T_odom_body);
  void draw_towards(const RefinedPose& refined);
  void resample(const std::vector<double>& weights, std::size_t count);
  std::size_t particles_needed(const std::vector<double>& weights) const;
  GlobalSearch::Candidates search(const LevelScan& scan, const Pose2& T_odom_body) const;
  LocalizationUpdate describe(const LevelScan& scan, const RefinedPose& refined);
  ParticleSet logged_particles(Time stamp) const;

  MonteCarloSettings settings_;
  RangeMemory ranges_;
  LineField lines_;
  std::unique_ptr<SensorModel> sensor_model_;
  GlobalSearch search_;
  RandomStream start_noise_, motion_noise_, resampling_noise_, proposal_noise_, injection_noise_;
  FitMonitor fit_;

  ParticleCloud cloud_;
  bool starts_anywhere_ = true;
  std::uint64_t starts_ = 0;   ///< so far
  std::uint64_t updates_ = 0;  ///< that weighed the particles, so far
  slam::PoseGaussian belief_;  ///< of the heaviest clump at the last weighing, its scan and ranges included
  double clump_weight_ = 0.0;
  bool is_lost_ = true;
  std::optional<Pose2> T_odom_last_;  ///< at the last weighing; none before the first
  Time last_weighing_{};
  Time last_scan_{};
  std::optional<Time> last_search_;
};

}  // namespace patrol::localize
