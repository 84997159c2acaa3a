#include "slam/graph/graph_slam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "slam/graph/degeneracy.h"
#include "slam/graph/edge_weight.h"
#include "slam/graph/nearest.h"
#include "slam/graph/relative_covariance.h"
#include "slam/map_rendering.h"

namespace patrol::slam {
namespace {

/// Drift along directions that the scans determine, as a fraction of that of odometry.
constexpr double kTrackedDrift = 0.25;

}  // namespace

GraphSlam::GraphSlam(const GraphSlamSettings& settings)
    : settings_(settings),
      rendering_{.resolution_m = settings.scan_odometry.resolution_m,
                 .max_extent_m = settings.scan_odometry.max_extent_m,
                 .integration = settings.scan_odometry.integration},
      tracker_(settings.scan_odometry),
      cache_(static_cast<std::size_t>(settings.cached_submaps)),
      incremental_map_(rendering_),
      survey_{.ranges = RangeFactors(settings.ranges), .positions = PositionFactors(settings.positions)} {
  validate(settings, "slam.graph");
}

SlamUpdate GraphSlam::update(const LevelScan& input_scan, const Pose2& T_odom_body) {
  const LevelScan without_beams{.stamp = input_scan.stamp, .tilt_rad = input_scan.tilt_rad, .beams = {}};
  const LevelScan& scan = input_scan.tilt_rad <= settings_.max_tilt_rad ? input_scan : without_beams;
  const TrackedScan tracked = tracker_.update(scan, T_odom_body);
  if (tracked.is_keyframe) add_keyframe(tracked);
  update_estimate(tracked, scan.stamp);
  gate_ranges(tracked, T_odom_body);
  add_positions(tracked, T_odom_body);
  if (tracked.is_keyframe && !survey_.ranges.ranges().empty() &&
      survey_.ranges.ranges().back().node >= smoothed_until_ + settings_.range_smoothing_period_keyframes)
    smooth_with_ranges(first_submap_ + tracked.submap);
  path_.push_back({static_cast<int>(keyframes_.size()) - 1, tracked.T_local_body});
  now_.mean = T_map_body(tracked.T_local_body);
  return {.T_map_body = now_.mean,
          .covariance = now_.covariance,
          .is_keyframe = tracked.is_keyframe,
          .match_score = tracked.inlier_ratio};
}

Pose2 GraphSlam::T_map_body(const Pose2& T_local_body) const {
  return graph_.T_map_node.back() * (keyframes_.back().T_local_body.inverse() * T_local_body);
}

void GraphSlam::add_keyframe(const TrackedScan& tracked) {
  const int node = static_cast<int>(keyframes_.size());
  matches_.push_back({.is_matched = tracked.inlier_ratio > 0.0});
  if (const auto degenerate = degenerate_direction(tracked.match_information, settings_.min_eigenvalue_ratio))
    matches_.back().undetermined = Eigen::Rotation2Dd(-tracked.T_local_body.yaw) * *degenerate;
  if (node == first_keyframe_) {
    graph_.T_map_node.push_back(tracked.T_local_body);
  } else {
    const Keyframe& before = keyframes_.back();
    const Pose2 T_before_node = before.T_local_body.inverse() * tracked.T_local_body;
    graph_.T_map_node.push_back(graph_.T_map_node.back() * T_before_node);
    const PoseGaussian motion = predict_motion(
        {}, T_before_node, to_seconds(tracked.scans.stamp() - before.scans.stamp()), settings_.scan_odometry.motion);
    graph_.edges.push_back({.from = node - 1,
                            .to = node,
                            .T_from_to = T_before_node,
                            .information = motion.covariance.inverse(),
                            .kind = PoseGraphEdge::Kind::kOdometry});
    if (tracked.inlier_ratio > 0.0) add_match_edge(tracked);
  }
  keyframes_.push_back({tracked.scans, tracked.T_local_body});
  if (tracked.is_submap_start) submaps_.push_back({.first = node, .last = node});
  const int submap = first_submap_ + tracked.submap;
  for (auto s = static_cast<std::size_t>(submap); s < submaps_.size(); ++s) submaps_[s].last = node;
  while (finished_submaps_ < submap) close_loops(finished_submaps_++);
}

// Adds an edge between the newest node and its matched submap.
void GraphSlam::add_match_edge(const TrackedScan& tracked) {
  const int first = submaps_[static_cast<std::size_t>(first_submap_ + tracked.submap)].first,
            node = static_cast<int>(graph_.T_map_node.size()) - 1;
  const Pose2& T_local_first = keyframes_[static_cast<std::size_t>(first)].T_local_body;
  graph_.edges.push_back(
      {.from = first,
       .to = node,
       .T_from_to = T_local_first.inverse() * tracked.T_local_body,
       .information = match_edge_information(rotate_covariance(tracked.match_information, -T_local_first.yaw)),
       .kind = PoseGraphEdge::Kind::kMatch});
}

Eigen::Matrix3d GraphSlam::match_edge_information(const Eigen::Matrix3d& match_information) const {
  return edge_information(observable_information(match_information), settings_.edge_std_m, settings_.edge_std_rad);
}

// Information along a degenerate direction is noise: project it out.
Eigen::Matrix3d GraphSlam::observable_information(const Eigen::Matrix3d& match_information) const {
  const std::optional<Eigen::Vector2d> degenerate =
      degenerate_direction(match_information, settings_.min_eigenvalue_ratio);
  return settings_.scan_odometry.likelihood_tempering *
         (degenerate ? project_out(match_information, *degenerate) : match_information);
}

// Propagates the covariance with odometry and updates it with the match.
void GraphSlam::update_estimate(const TrackedScan& tracked, Time stamp) {
  const Pose2 T_local_last = path_.empty() ? tracked.T_local_body : path_.back().T_local_body,
              T_map_now = T_map_body(tracked.T_local_body);
  if (!path_.empty()) {
    const Eigen::Matrix3d step =
        predict_motion({}, T_local_last.inverse() * tracked.T_local_body, std::max(0.0, to_seconds(stamp - stamp_)),
                       settings_.scan_odometry.motion)
            .covariance;
    now_.covariance = compose_covariance(now_, T_map_now, step);
    const Eigen::Matrix3d match =
        rotate_covariance(observable_information(tracked.match_information), T_map_now.yaw - tracked.T_local_body.yaw);
    now_.covariance = (now_.covariance.inverse() + match).inverse();
  }
  now_.mean = T_map_now;
  stamp_ = stamp;
}

void GraphSlam::gate_ranges(const TrackedScan& tracked, const Pose2& T_odom_body) {
  std::vector<RangeMeasurement> measurements = std::exchange(new_ranges_, {});
  if (!settings_.ranges.enabled) return;
  const Pose2& T_survey_map = survey_.positions.T_survey_map();
  const Pose2 T_node_body = keyframes_.back().T_local_body.inverse() * tracked.T_local_body;
  RangeUpdateSettings gating = settings_.ranges;
  gating.range_std_m = Eigen::Vector3d(gating.range_std_m, gating.common_std_m, gating.anchor_delay_std_m).norm();
  RangeUpdateSettings wide = gating;  // for a map that is still bent: the kernel of the factors is the finer gate
  wide.range_std_m = std::hypot(wide.range_std_m, settings_.surveyed_submap_std_m);
  for (const RangeMeasurement& measurement : measurements) {
    RangeMeasurement corrected = measurement;  // to an anchor in map
    corrected.range_m -= survey_.ranges.delay_m(measurement.anchor.number);
    corrected.anchor.p_m.head<2>() = T_survey_map.inverse() * Eigen::Vector2d(measurement.anchor.p_m.head<2>());
    if (!passes_gate(range_innovation(now_, T_odom_body, corrected, wide), wide)) continue;
    survey_.ranges.add(static_cast<int>(keyframes_.size()) - 1, T_survey_map * graph_.T_map_node.back(),
                       T_node_body * (T_odom_body.inverse() * measurement.T_odom_body), measurement);
    if (!passes_gate(range_innovation(now_, T_odom_body, corrected, gating), gating)) continue;
    PoseGaussian updated = now_;
    update_with_ranges({corrected}, T_odom_body, gating, updated);
    now_.covariance = updated.covariance;
  }
}

std::vector<MappedRange> GraphSlam::mapped_ranges() const {
  std::vector<MappedRange> mapped;
  for (const RangeFactor& factor : survey_.ranges.ranges()) {
    mapped.push_back({.anchor = factor.anchor_in_survey.number,
                      .T_map_body = graph_.T_map_node[static_cast<std::size_t>(factor.node)],
                      .p_level_antenna = factor.p_level_antenna,
                      .range_m = factor.range_m,
                      .count = factor.count});
  }
  return mapped;
}

void GraphSlam::add_positions(const TrackedScan& tracked, const Pose2& T_odom_body) {
  const Pose2 T_node_body = keyframes_.back().T_local_body.inverse() * tracked.T_local_body;
  for (const PositionMeasurement& measurement : std::exchange(new_positions_, {})) {
    survey_.positions.add(static_cast<int>(keyframes_.size()) - 1,
                          T_node_body * (T_odom_body.inverse() * measurement.T_odom_body), measurement);
  }
}

// Fixed-lag smoothing: free nodes begin at the submap before the matched one.
void GraphSlam::smooth_with_ranges(int submap) {
  solve(graph_, settings_.solver, survey_,
        std::max(1, submaps_[static_cast<std::size_t>(std::max(0, submap - 1))].first));
  smoothed_until_ = static_cast<int>(keyframes_.size()) - 1;
}

Eigen::Vector2d GraphSlam::submap_center(int submap) const {
  const Submap& range = submaps_[static_cast<std::size_t>(submap)];
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = range.first; k <= range.last; ++k) sum += graph_.T_map_node[static_cast<std::size_t>(k)].position();
  return sum / (range.last - range.first + 1);
}

// Uses the drift between consecutive submaps and the loop closures. An earlier map is optimized: its submaps do not
// drift. Submaps of other sessions have infinite covariance until a loop is closed.
std::vector<PoseGaussian> GraphSlam::relative_pose_distributions(int submap, Drift drift) const {
  std::vector<Pose2> T_map_submaps;
  for (int s = 0; s < finished_submaps_; ++s) T_map_submaps.push_back(T_map_submap(s));
  std::vector<CovarianceEdge> covariance_edges;
  const Eigen::Matrix3d earlier =
      Eigen::Vector3d(settings_.edge_std_m, settings_.edge_std_m, settings_.edge_std_rad).cwiseAbs2().asDiagonal();
  for (int s = 0; s + 1 < finished_submaps_; ++s) {
    if (s + 1 == first_submap_) continue;  // between the sessions there are only loop closures
    covariance_edges.push_back(
        {.from = s, .to = s + 1, .covariance = s < first_submap_ ? earlier : drift_covariance(s, drift)});
  }
  for (const LoopEdge& loop : loops_) {
    covariance_edges.push_back({.from = loop.target,
                                .to = loop.source,
                                .covariance = graph_.edges[static_cast<std::size_t>(loop.edge)].information.inverse()});
  }
  return shortest_path_distributions(submap, T_map_submaps, covariance_edges);
}

// Covariance of the next submap's pose in this submap's frame. Tracked scans reduce the drift of odometry along the
// directions that they determine. The drift settings are those of a tracked path: unmatched steps have the uncertainty
// of odometry.
Eigen::Matrix3d GraphSlam::drift_covariance(int submap, Drift drift) const {
  const int first = submaps_[static_cast<std::size_t>(submap)].first,
            next = submaps_[static_cast<std::size_t>(submap) + 1].first;
  const double yaw_first = keyframes_[static_cast<std::size_t>(first)].T_local_body.yaw;
  double length_m = 0.0, turn_rad = 0.0, undetermined_m = 0.0;
  Eigen::Matrix2d undetermined_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix3d unmatched = Eigen::Matrix3d::Zero();
  for (int k = first; k < next; ++k) {
    const Pose2& T_local_next = keyframes_[static_cast<std::size_t>(k) + 1].T_local_body;
    const Pose2 step = keyframes_[static_cast<std::size_t>(k)].T_local_body.inverse() * T_local_next;
    const KeyframeMatch& match = matches_[static_cast<std::size_t>(k + 1 - first_keyframe_)];
    const double fraction = drift == Drift::kTracked && match.is_matched ? kTrackedDrift : 1.0;
    if (!match.is_matched) {
      const double yaw = keyframes_[static_cast<std::size_t>(k)].T_local_body.yaw - yaw_first;
      unmatched += predict_motion({0.0, 0.0, yaw}, step, 0.0, settings_.scan_odometry.motion).covariance;
    }
    length_m += fraction * step.position().norm();
    turn_rad += fraction * std::abs(step.yaw);
    if (drift == Drift::kOdometry) continue;
    const Eigen::Vector2d direction = Eigen::Rotation2Dd(T_local_next.yaw - yaw_first) * match.undetermined;
    undetermined_m += direction.squaredNorm() * step.position().norm();
    undetermined_m2 += step.position().norm() * direction * direction.transpose();
  }
  const double std_m = settings_.drift_std_m_per_m * length_m,
               std_rad = settings_.drift_std_rad_per_m * length_m + settings_.drift_std_rad_per_rad * turn_rad;
  Eigen::Matrix3d covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal();
  covariance += unmatched;
  covariance.topLeftCorner<2, 2>() +=
      settings_.drift_std_m_per_m * settings_.drift_std_m_per_m * undetermined_m * undetermined_m2;
  return covariance;
}

// Fuses the covariance of a relative pose by scans and odometry with that of two surveyed positions.
Eigen::Matrix3d GraphSlam::limited_by_survey(const Eigen::Matrix3d& covariance, int target, int source) const {
  if (!is_surveyed(submaps_[static_cast<std::size_t>(target)]) ||
      !is_surveyed(submaps_[static_cast<std::size_t>(source)]))
    return covariance;
  const double variance_m2 = 2.0 * settings_.surveyed_submap_std_m * settings_.surveyed_submap_std_m;
  Eigen::Matrix3d information = covariance.inverse();
  information.diagonal().head<2>().array() += 1.0 / variance_m2;
  return information.inverse();
}

// Returns older submaps within the search radius, which includes the drift, nearest first.
std::vector<int> GraphSlam::submaps_near(int source, const std::vector<PoseGaussian>& around) const {
  const Eigen::Vector2d center = submap_center(source);
  std::vector<std::pair<double, int>> near;  // sorted by distance
  for (int target = 0; target < source; ++target) {
    // overlapping submaps
    if (submaps_[static_cast<std::size_t>(target)].last >= submaps_[static_cast<std::size_t>(source)].first) continue;
    const Eigen::Matrix3d& covariance = around[static_cast<std::size_t>(target)].covariance;
    if (!covariance.allFinite()) continue;
    const double search_radius_m =
        settings_.max_loop_distance_m + 2.0 * std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
    const double distance_m = (submap_center(target) - center).norm();
    if (distance_m < search_radius_m) near.emplace_back(distance_m, target);
  }
  return nearest(near, settings_.max_loop_candidates);
}

void GraphSlam::close_loops(int source) {
  if (!is_located_) locate(source);
  const bool has_closed = add_loops(source, relative_pose_distributions(source));
  if (has_closed || is_surveyed(submaps_[static_cast<std::size_t>(source)])) optimize();
}

// The pose of a session that is not located is fixed by its first node.
void GraphSlam::optimize() { solve(graph_, settings_.solver, survey_, is_located_ ? 1 : first_keyframe_ + 1); }

bool GraphSlam::add_loops(int source, const std::vector<PoseGaussian>& around) {
  bool has_closed = false;
  std::vector<PoseGaussian> tracked;
  for (const int target : submaps_near(source, around)) {
    PoseGaussian prediction = invert(around[static_cast<std::size_t>(target)]);  // pose of source in target
    prediction.covariance = limited_by_survey(prediction.covariance, target, source);
    SubmapMatchResult result = match_submaps(*rendered(target), *rendered(source), prediction, settings_.loop_closure,
                                             settings_.scan_odometry.matching);
    if (result.failure == MatchFailure::kAmbiguous && target >= first_submap_) {
      if (tracked.empty()) tracked = relative_pose_distributions(source, Drift::kTracked);
      result = match_submaps_by_tracking(*rendered(target), *rendered(source),
                                         invert(tracked[static_cast<std::size_t>(target)]), settings_.loop_closure,
                                         settings_.scan_odometry.matching);
    }
    loop_closure_statistics_.add(result.failure);
    if (!result.match) continue;
    has_closed = true;
    loops_.push_back({.target = target, .source = source, .edge = static_cast<int>(graph_.edges.size())});
    graph_.edges.push_back({.from = submaps_[static_cast<std::size_t>(target)].first,
                            .to = submaps_[static_cast<std::size_t>(source)].first,
                            .T_from_to = result.match->T_target_source,
                            .information = match_edge_information(result.match->information),
                            .kind = PoseGraphEdge::Kind::kLoop});
  }
  return has_closed;
}

std::shared_ptr<const RenderedSubmap> GraphSlam::rendered(int submap) {
  return cache_.get(submap, [&] {
    return std::make_shared<const RenderedSubmap>(submaps_[static_cast<std::size_t>(submap)], keyframes_,
                                                  graph_.T_map_node, rendering_);
  });
}

std::shared_ptr<const RenderedSubmap> GraphSlam::render_again(int submap,
                                                              const std::vector<Pose2>& T_map_submap_node) const {
  const int first = submaps_.at(static_cast<std::size_t>(submap)).first;
  std::vector<Pose2> T_map_node(keyframes_.size());
  std::ranges::copy(T_map_submap_node, T_map_node.begin() + first);
  const Submap then{.first = first, .last = first + static_cast<int>(T_map_submap_node.size()) - 1};
  return std::make_shared<const RenderedSubmap>(then, keyframes_, T_map_node, rendering_);
}

std::vector<std::size_t> GraphSlam::node_scan_indices() const {
  std::vector<std::size_t> scans;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    if (path_[i].keyframe == first_keyframe_ + static_cast<int>(scans.size())) scans.push_back(i);
  }
  return scans;
}

// Poses between two keyframes are interpolated between the corrections of both, by the distance to each.
std::vector<Pose2> GraphSlam::path() const {
  std::vector<Pose2> T_map_body;
  for (const TrackedPose& tracked : path_) {
    const auto before = static_cast<std::size_t>(tracked.keyframe);
    const Pose2 from_before =
        graph_.T_map_node[before] * (keyframes_[before].T_local_body.inverse() * tracked.T_local_body);
    const std::size_t after = before + 1;
    if (after >= keyframes_.size()) {
      T_map_body.push_back(from_before);
      continue;
    }
    const Pose2 from_after =
        graph_.T_map_node[after] * (keyframes_[after].T_local_body.inverse() * tracked.T_local_body);
    const auto distance = [&](std::size_t k) {
      const Pose2 offset = keyframes_[k].T_local_body.inverse() * tracked.T_local_body;
      return offset.position().norm() + std::abs(offset.yaw);
    };
    const double to_before = distance(before), to_after = distance(after),
                 fraction = to_before + to_after > 0.0 ? to_before / (to_before + to_after) : 0.0;
    T_map_body.push_back({from_before.x + fraction * (from_after.x - from_before.x),
                          from_before.y + fraction * (from_after.y - from_before.y),
                          wrap_angle(from_before.yaw + fraction * wrap_angle(from_after.yaw - from_before.yaw))});
  }
  return T_map_body;
}

OccupancyGrid GraphSlam::map() {
  const GridMap& map =
      incremental_map_.render(keyframes_, graph_.T_map_node, is_finished_ ? 0.0 : settings_.map_update_threshold_m);
  return render_map(map, settings_.min_hits_occupied, settings_.min_occupied_hit_ratio);
}

}  // namespace patrol::slam
