#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "core/messages.h"
#include "core/named_table.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/amcl/beam_model.h"
#include "localize/amcl/confidence.h"
#include "localize/amcl/divergence_monitor.h"
#include "localize/amcl/global_search.h"
#include "localize/amcl/kld.h"
#include "localize/amcl/likelihood_field.h"
#include "localize/amcl/line_field.h"
#include "localize/amcl/monte_carlo_settings.h"
#include "localize/amcl/odometry_model.h"
#include "localize/amcl/particle_cloud.h"
#include "localize/amcl/pose_refinement.h"
#include "localize/amcl/range_buffer.h"
#include "localize/amcl/range_likelihood.h"
#include "localize/amcl/sensor_model.h"

namespace patrol::localize {

struct LocalizationUpdate {
  PoseEstimate estimate;
  LocalizationConfidence confidence;
  /// True: the particles were updated; false: only the pose was predicted and matched to the map.
  bool particles_updated = false;
  std::optional<ParticleSet> particles;  ///< regular subset of the updated particles, for the log
  int num_particles = 0;                 ///< current number of particles
  int num_injected = 0;                  ///< number of particles replaced by samples of a global search
  double cluster_weight = 0.0;           ///< weight of the particle cluster behind the estimate
  double inlier_ratio = 0.0;             ///< fraction of the scan points on surfaces of the map
};

/// Adaptive Monte Carlo localization on a known map [Thrun05, chapter 8] with KLD sampling [Fox03]. UWB ranges enter as
/// weights, not as positions.
///
///   every scan       predict the Gaussian by odometry -> match the scan to the map -> pose, covariance, confidence
///   particle update  propagate -> weight by ranges -> weight by scan -> match the scan to the map -> resample, inject
///
/// A tracked pose does not jump. Another cluster than the one that continues it is published only after the robot was
/// reported as lost, and only if the ranges do not contradict it.
///
/// The particle set represents multimodal beliefs: global localization, kidnapping, both directions of a tunnel. The
/// published pose is a Gaussian: the prior is the followed particle cluster before the scan, the update a scan match
/// (pose_refinement.h). The followed cluster is the tracked one, and the dominant one of a robot that is lost.
/// Accuracy: millimeters where the scan constrains the pose, otherwise the spread of the cluster.
class MonteCarloLocalizer {
 public:
  /// Anchors are in map, with heights above the body origin, for level ground. `calibration`: bias of the UWB ranges.
  /// Throws InputError if a setting is invalid, or if the map is empty or has no free or no occupied cell.
  MonteCarloLocalizer(const MonteCarloSettings& settings, const OccupancyGrid& map,
                      const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb, std::uint64_t seed,
                      const UwbCalibration& calibration = {});

  /// Sets the initial pose; covariance of x, y, yaw in map.
  void set_initial_pose(const Pose2& T_map_body, const Eigen::Matrix3d& covariance);
  /// Starts global localization: the next scan is searched for on the whole map.
  void start_global_localization();

  /// Moves the anchors in map.
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map) { ranges_.set_anchors(anchors_in_map); }
  /// Adds a UWB range; `T_odom_body` is the odometry at its stamp. Ranges of unknown anchors and ranges that are not
  /// finite and positive are ignored. The newest range of each anchor is used in the next particle update.
  void add(const UwbRange& range, const Pose3& T_odom_body) { ranges_.add(range, T_odom_body); }
  /// Processes a scan; `T_odom_body` is the odometry at its stamp.
  LocalizationUpdate update(const LevelScan& input_scan, const Pose2& T_odom_body);

  const ParticleCloud& particles() const { return cloud_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(ranges_, divergence_monitor_, cloud_, is_globally_started_, starts_, updates_, cluster_gaussian_,
            cluster_weight_, is_lost_, T_odom_last_, last_update_stamp_, last_scan_, last_search_);
  }

 private:
  void start_from(const LevelScan& scan, const Pose2& T_odom_body);
  bool is_due(const Pose2& T_before_now, Time stamp) const;
  void update_range_fit(const std::vector<AnchoredRange>& ranges, const slam::PoseGaussian& prediction);
  RefinedPose update_weights(const LevelScan& scan, const Pose2& T_odom_body, const slam::PoseGaussian& prediction);
  int resample_and_inject(const LevelScan& scan, const Pose2& T_odom_body);
  void apply_scan_proposal(const RefinedPose& refined);
  void resample(const std::vector<double>& weights, std::size_t count);
  std::size_t particles_needed(const std::vector<double>& weights) const;
  /// Returns the newest range of each anchor within the buffer time.
  std::vector<AnchoredRange> buffered_ranges(Time now, const Pose2& T_odom_body) const;
  GlobalSearch::Candidates global_localization(const LevelScan& scan, const Pose2& T_odom_body) const;
  LocalizationUpdate describe(const LevelScan& scan, const RefinedPose& refined);
  ParticleSet logged_particles(Time stamp) const;

  MonteCarloSettings settings_;
  RangeBuffer ranges_;
  LineField lines_;
  std::unique_ptr<SensorModel> sensor_model_;
  GlobalSearch search_;
  RandomStream start_noise_, motion_noise_, resampling_noise_, proposal_noise_, injection_noise_;
  DivergenceMonitor divergence_monitor_;

  ParticleCloud cloud_;
  bool is_globally_started_ = true;
  std::uint64_t starts_ = 0;   ///< number of starts
  std::uint64_t updates_ = 0;  ///< number of particle updates
  /// Gaussian of the dominant cluster at the last particle update, including its scan and ranges
  slam::PoseGaussian cluster_gaussian_;
  double cluster_weight_ = 0.0;
  bool is_lost_ = true;
  std::optional<Pose2> T_odom_last_;  ///< odometry at the last particle update; none before the first
  Time last_update_stamp_{};
  Time last_scan_{};
  std::optional<Time> last_search_;
};

}  // namespace patrol::localize
