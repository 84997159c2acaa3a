#include "localize/amcl/monte_carlo.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "core/map_cells.h"
#include "core/particle_weights.h"

namespace patrol::localize {
namespace {

// Pose resolution of the particles, limited by the likelihood tolerance and their number.
const Eigen::Vector3d kMinStd(0.02, 0.02, 0.003);
constexpr int kLineRadius_cells = 6;
constexpr int kMinPoints = 10;   // minimum number of scan points for the scan fit
constexpr double kNear_m = 3.0;  // maximum distance from the pose within which the scan match applies to a particle
constexpr double kMaxNeededFraction = 0.67;  // resample if fewer than this fraction of the particles suffices
constexpr Time kRangesBeforeStart = std::chrono::seconds(2);  // maximum age of ranges used in the first particle update

const OccupancyGrid& checked(const OccupancyGrid& map) {
  const auto& cells = map.values();
  if (cells.empty()) throw InputError("localization: map: has no cells");
  if (std::none_of(cells.begin(), cells.end(), is_free)) throw InputError("localization: map: has no free cell");
  if (std::none_of(cells.begin(), cells.end(), is_occupied))
    throw InputError("localization: map: has no occupied cell");
  return map;
}

const MonteCarloSettings& checked(const MonteCarloSettings& settings) {
  validate(settings, "localization");
  return settings;
}

using Model = std::unique_ptr<SensorModel>;

constexpr std::array kSensorModels = std::to_array<SensorModelFactory>({
    {"likelihood_field", "Distance of each beam's end to the nearest surface of the map",
     [](const MonteCarloSettings& settings, const OccupancyGrid& map, const LineField& lines) -> Model {
       return std::make_unique<LikelihoodField>(settings.likelihood_field, map, lines);
     }},
    {"beam", "Range of each beam against the range to the map's first surface along it",
     [](const MonteCarloSettings& settings, const OccupancyGrid& map, const LineField&) -> Model {
       return std::make_unique<BeamModel>(settings.beam, map);
     }},
});

}  // namespace

std::span<const SensorModelFactory> sensor_models() { return kSensorModels; }

MonteCarloLocalizer::MonteCarloLocalizer(const MonteCarloSettings& settings, const OccupancyGrid& map,
                                         const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb,
                                         std::uint64_t seed, const UwbCalibration& calibration)
    : settings_(checked(settings)),
      ranges_(anchors_in_map, T_body_uwb, calibration),
      lines_(checked(map), kLineRadius_cells),
      sensor_model_(
          row_named(kSensorModels, settings.sensor_model, "localization.sensor_model").make(settings, map, lines_)),
      search_(settings.global_localization, settings.likelihood_field, map, lines_),
      start_noise_(seed, "localize/start"),
      motion_noise_(seed, "localize/motion"),
      resampling_noise_(seed, "localize/resampling"),
      proposal_noise_(seed, "localize/proposal"),
      injection_noise_(seed, "localize/injection"),
      divergence_monitor_(settings.divergence_monitor) {}

void MonteCarloLocalizer::set_initial_pose(const Pose2& T_map_body, const Eigen::Matrix3d& covariance) {
  start_global_localization();
  is_globally_started_ = is_lost_ = false;
  cluster_gaussian_ = {.mean = T_map_body, .covariance = covariance};
  cluster_gaussian_.covariance.diagonal() += kMinStd.cwiseAbs2();
  cluster_weight_ = 1.0;
  const Eigen::Matrix3d L = cholesky_factor(cluster_gaussian_.covariance);
  PoseBins bins(settings_.kld);
  while (cloud_.size() < static_cast<std::size_t>(kld_particles(bins.size(), settings_.kld))) {
    const std::array<double, 4> unit = start_noise_.normals(starts_, cloud_.size());
    const Pose2 pose = slam::perturbed(T_map_body, L * Eigen::Vector3d(unit[0], unit[1], unit[2]));
    cloud_.add(pose, settings_.odometry.scale_std * unit[3]);
    bins.add(pose);
  }
}

void MonteCarloLocalizer::start_global_localization() {
  ++starts_;
  is_globally_started_ = is_lost_ = true;
  cloud_ = {};
  divergence_monitor_.reset();
  T_odom_last_.reset();
  last_search_.reset();
}

LocalizationUpdate MonteCarloLocalizer::update(const LevelScan& input_scan, const Pose2& T_odom_body) {
  const LevelScan without_beams{
      .stamp = input_scan.stamp, .origin_m = input_scan.origin_m, .tilt_rad = input_scan.tilt_rad, .beams = {}};
  const LevelScan& scan = !is_lost_ && input_scan.tilt_rad > settings_.max_tilt_rad ? without_beams : input_scan;
  if (is_globally_started_) start_from(scan, T_odom_body);
  const bool is_first = !T_odom_last_;
  if (is_first) T_odom_last_ = T_odom_body, last_update_stamp_ = last_scan_ = scan.stamp - kRangesBeforeStart;
  const Pose2 T_before_now = T_odom_last_->inverse() * T_odom_body;
  const double dt_s = is_first ? 0.0 : to_seconds(scan.stamp - last_update_stamp_);

  const slam::PoseGaussian prediction = predict(cluster_gaussian_, T_before_now, dt_s, settings_.odometry);
  update_range_fit(ranges_.ranges_since(last_scan_, T_odom_body), prediction);
  last_scan_ = scan.stamp;
  if (!is_first && !is_due(T_before_now, scan.stamp)) {
    return describe(scan, refine_pose(lines_, scan, prediction, prediction.mean, settings_.scan_refinement));
  }

  propagate_particles(cloud_, T_before_now, dt_s, settings_.odometry, motion_noise_, updates_);
  const RefinedPose refined = update_weights(scan, T_odom_body, prediction);
  LocalizationUpdate update = describe(scan, refined);
  update.particles_updated = true;
  update.particles = logged_particles(scan.stamp);
  update.num_injected = resample_and_inject(scan, T_odom_body);
  if (refined.is_matched && !is_lost_) apply_scan_proposal(refined);
  update.num_particles = static_cast<int>(cloud_.size());
  T_odom_last_ = T_odom_body;
  last_update_stamp_ = scan.stamp;
  ++updates_;
  return update;
}

void MonteCarloLocalizer::start_from(const LevelScan& scan, const Pose2& T_odom_body) {
  const auto count = static_cast<std::size_t>(std::max(settings_.kld.min_particles, settings_.kld.max_particles));
  const std::vector<Pose2> poses = sample_poses(global_localization(scan, T_odom_body), count, start_noise_, starts_);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    cloud_.add(poses[i], settings_.odometry.scale_std * start_noise_.normals(starts_, count + i)[3]);
  }
  is_globally_started_ = false;
  last_search_ = scan.stamp;
}

bool MonteCarloLocalizer::is_due(const Pose2& T_before_now, Time stamp) const {
  return T_before_now.position().norm() >= settings_.update_distance_m ||
         std::abs(T_before_now.yaw) >= settings_.update_angle_rad ||
         (is_lost_ && to_seconds(stamp - last_update_stamp_) >= settings_.update_period_s);
}

// The variance of the predicted pose is added to that of the range.
void MonteCarloLocalizer::update_range_fit(const std::vector<AnchoredRange>& ranges,
                                           const slam::PoseGaussian& prediction) {
  for (const AnchoredRange& range : ranges) {
    const Eigen::Vector2d to_anchor = (range.p_map_anchor.head<2>() - prediction.mean.position()).stableNormalized();
    const double prediction_var = to_anchor.dot(prediction.covariance.topLeftCorner<2, 2>() * to_anchor);
    RangeLikelihoodSettings inflated = settings_.ranges;
    inflated.range_std_m = std::sqrt(inflated.range_std_m * inflated.range_std_m + prediction_var);
    divergence_monitor_.add_range(std::exp(range_log_likelihood(range_innovation_m(range, prediction.mean), inflated)));
  }
}

// The pose combines the belief before the scan with the scan, each used once.
RefinedPose MonteCarloLocalizer::update_weights(const LevelScan& scan, const Pose2& T_odom_body,
                                                const slam::PoseGaussian& prediction) {
  for (const AnchoredRange& range : ranges_.ranges_since(last_update_stamp_, T_odom_body)) {
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      cloud_.log_weights[i] += range_log_likelihood(range_innovation_m(range, cloud_.T_map_body[i]), settings_.ranges);
    }
  }
  const std::vector<double> prior_weights = normalized_weights(cloud_.log_weights);

  const ScanLikelihoods fits = sensor_model_->evaluate(scan, cloud_.T_map_body);
  const double gain = std::min(settings_.effective_beams, static_cast<double>(fits.num_beams));
  // Differences within the tolerance of map and model do not affect the weights.
  const double good = *std::max_element(fits.mean_log.begin(), fits.mean_log.end()) - settings_.scan_fit_tolerance;
  double likelihood = 0.0;
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    cloud_.log_weights[i] += gain * std::min(0.0, fits.mean_log[i] - good);
    likelihood += prior_weights[i] * std::exp(fits.mean_log[i]);
  }
  if (fits.num_beams > 0) divergence_monitor_.add_scan_likelihood(likelihood);
  const std::vector<double> weights = normalized_weights(cloud_.log_weights);

  const std::vector<std::size_t> clusters = cluster_particles(cloud_.T_map_body, settings_.kld);
  const ParticleCluster dominant = find_dominant_cluster(clusters, weights);
  const std::optional<ParticleCluster> tracked = find_cluster_near(prediction, cloud_.T_map_body, clusters, weights);
  const ParticleCluster without_weight{.number = dominant.number, .weight = 0.0};
  const ParticleCluster followed = is_lost_ ? dominant : tracked.value_or(without_weight);
  cluster_weight_ = followed.weight;
  cluster_gaussian_ = cluster_gaussian(cloud_.T_map_body, weights, clusters, followed.number);
  slam::PoseGaussian prior = cluster_gaussian(cloud_.T_map_body, prior_weights, clusters, followed.number);
  if (!prior.covariance.allFinite()) prior = cluster_gaussian_;
  cluster_gaussian_.covariance.diagonal() += kMinStd.cwiseAbs2();
  prior.covariance.diagonal() += kMinStd.cwiseAbs2();
  const std::vector<AnchoredRange> buffered = buffered_ranges(scan.stamp, T_odom_body);
  if ((!tracked || tracked->number != followed.number) && !buffered.empty())
    divergence_monitor_.set_range_fit(mean_range_likelihood(buffered, cluster_gaussian_.mean, settings_.ranges));
  return refine_pose(lines_, scan, prior, cluster_gaussian_.mean, settings_.scan_refinement);
}

// A pose that makes two more ranges outliers than the present one is not injected: a scan of a place that has changed
// since it was mapped can look like that of another place, scan after scan.
// An injected particle that contradicts ranges which the present pose explains starts with their likelihood ratio: the
// cloud has been weighted by them, and the next update may not contain one that tells the two apart.
int MonteCarloLocalizer::resample_and_inject(const LevelScan& scan, const Pose2& T_odom_body) {
  const bool may_search = !last_search_ || to_seconds(scan.stamp - *last_search_) >= settings_.search_period_s;
  const double injected_fraction = may_search ? divergence_monitor_.injection_fraction() : 0.0;
  const std::vector<double> weights = normalized_weights(cloud_.log_weights);
  const auto count = static_cast<double>(cloud_.size());
  const std::size_t needed = particles_needed(weights);
  const bool is_wasteful = static_cast<double>(needed) < kMaxNeededFraction * count;
  if (injected_fraction > 0.0 || is_wasteful || effective_sample_size(weights) < settings_.resample_threshold * count)
    resample(weights, needed);

  const auto num_injected = static_cast<std::size_t>(injected_fraction * static_cast<double>(cloud_.size()));
  if (num_injected == 0) return 0;
  last_search_ = scan.stamp;
  const std::vector<Pose2> poses =
      sample_poses(global_localization(scan, T_odom_body), num_injected, injection_noise_, updates_);
  const std::vector<AnchoredRange> ranges = buffered_ranges(scan.stamp, T_odom_body);
  const double present = ranges_log_likelihood(ranges, cluster_gaussian_.mean, settings_.ranges);
  // Between one and two outliers more: each lowers the likelihood by at most `outlier_probability`.
  const double min_log_ranges = present + 1.5 * std::log(settings_.ranges.outlier_probability);
  int injected = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double log_ranges = ranges_log_likelihood(ranges, poses[i], settings_.ranges);
    if (log_ranges < min_log_ranges) continue;
    ++injected;
    const std::size_t replaced = i * cloud_.size() / poses.size();
    cloud_.T_map_body[replaced] = poses[i];
    cloud_.log_weights[replaced] = std::min(0.0, log_ranges - present);
  }
  return injected;
}

// Samples the scan proposal for every other particle near the pose. The rest, which depend on odometry and likelihood
// field only, protect against a converged but wrong match.
void MonteCarloLocalizer::apply_scan_proposal(const RefinedPose& refined) {
  const ScanProposal proposal(refined, kMinStd.cwiseAbs2().asDiagonal());
  for (std::size_t i = 0; i < cloud_.size(); i += 2) {
    Pose2& pose = cloud_.T_map_body[i];
    if ((pose.position() - refined.posterior.mean.position()).norm() > kNear_m) continue;
    const std::array<double, 4> unit = proposal_noise_.normals(updates_, i);
    pose = proposal.sample(pose, {unit[0], unit[1], unit[2]});
  }
}

void MonteCarloLocalizer::resample(const std::vector<double>& weights, std::size_t count) {
  ParticleCloud children;
  for (const std::size_t parent : systematic_parents(weights, resampling_noise_.uniform(updates_), count)) {
    children.add(cloud_.T_map_body[parent], cloud_.odometry_scale[parent]);
  }
  cloud_ = std::move(children);
}

// Samples sequentially until the number of particles suffices for the occupied bins [Fox03, table 3]. Systematic
// resampling then repeats the sampling with less variance.
std::size_t MonteCarloLocalizer::particles_needed(const std::vector<double>& weights) const {
  std::vector<double> cumulative(weights.size());
  std::partial_sum(weights.begin(), weights.end(), cumulative.begin());
  PoseBins bins(settings_.kld);
  std::size_t num_samples = 0;
  while (num_samples < static_cast<std::size_t>(kld_particles(bins.size(), settings_.kld))) {
    const double pointer = resampling_noise_.uniform(updates_, ++num_samples);
    const auto parent = std::lower_bound(cumulative.begin(), cumulative.end() - 1, pointer) - cumulative.begin();
    bins.add(cloud_.T_map_body[static_cast<std::size_t>(parent)]);
  }
  const auto min_samples = static_cast<std::size_t>(is_lost_ ? settings_.min_particles_lost : 0);
  return std::max(num_samples, min_samples);
}

std::vector<AnchoredRange> MonteCarloLocalizer::buffered_ranges(Time now, const Pose2& T_odom_body) const {
  return ranges_.ranges_since(now - from_seconds(settings_.range_buffer_s), T_odom_body);
}

GlobalSearch::Candidates MonteCarloLocalizer::global_localization(const LevelScan& scan,
                                                                  const Pose2& T_odom_body) const {
  return search_.find(scan, buffered_ranges(scan.stamp, T_odom_body), settings_.ranges, settings_.effective_beams,
                      injection_noise_.uniform(updates_, 0));
}

LocalizationUpdate MonteCarloLocalizer::describe(const LevelScan& scan, const RefinedPose& refined) {
  if (refined.num_points >= kMinPoints) divergence_monitor_.add_scan_fit(refined.inlier_ratio);
  LocalizationUpdate update;
  update.estimate = {
      .stamp = scan.stamp, .T_map_body = refined.posterior.mean, .covariance = refined.posterior.covariance};
  update.confidence = assess_confidence(scan.stamp,
                                        {.covariance = refined.posterior.covariance,
                                         .cluster_weight = cluster_weight_,
                                         .scan_fit = divergence_monitor_.scan_fit(),
                                         .range_fit = divergence_monitor_.range_confidence()},
                                        is_lost_, settings_.confidence);
  update.num_particles = static_cast<int>(cloud_.size());
  update.cluster_weight = cluster_weight_;
  update.inlier_ratio = refined.inlier_ratio;
  is_lost_ = update.confidence.is_lost;
  return update;
}

ParticleSet MonteCarloLocalizer::logged_particles(Time stamp) const {
  ParticleSet set{.stamp = stamp, .T_map_body = {}, .weights = {}};
  const auto count = std::min(cloud_.size(), static_cast<std::size_t>(settings_.max_logged_particles));
  std::vector<double> log_weights;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * cloud_.size() / count;
    set.T_map_body.push_back(cloud_.T_map_body[from]);
    log_weights.push_back(cloud_.log_weights[from]);
  }
  set.weights = normalized_weights(log_weights);
  return set;
}

}  // namespace patrol::localize
