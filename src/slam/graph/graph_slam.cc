#include "slam/graph/graph_slam.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "slam/graph/way_uncertainty.h"
#include "slam/map_rendering.h"

namespace patrol::slam {
namespace {

/// The nearest of those that stand beside their distances, the nearest first.
std::vector<int> nearest(std::vector<std::pair<double, int>> by_distance, int limit) {
  std::sort(by_distance.begin(), by_distance.end());
  if (by_distance.size() > static_cast<std::size_t>(limit)) by_distance.resize(static_cast<std::size_t>(limit));
  std::vector<int> chosen;
  for (const auto& [distance_m, index] : by_distance) chosen.push_back(index);
  return chosen;
}

}  // namespace

void LoopCounts::add(MatchFailure failure) {
  ++searched;
  switch (failure) {
    case MatchFailure::kNone: ++closed; break;
    case MatchFailure::kNotFound: ++not_found; break;
    case MatchFailure::kAmbiguous: ++ambiguous; break;
    case MatchFailure::kNoOverlap: ++no_overlap; break;
    case MatchFailure::kMismatch: ++mismatched; break;
  }
}

GraphSlam::GraphSlam(const GraphSlamSettings& settings)
    : settings_(settings),
      drawing_{.resolution_m = settings.tracking.resolution_m, .max_extent_m = settings.tracking.max_extent_m, .integration = settings.tracking.integration},
      tracker_(settings.tracking),
      cache_(static_cast<std::size_t>(settings.cached_submaps)) {
  validate(settings, "slam");
}

Pose2 GraphSlam::update(const LevelScan& scan, const Pose2& T_odom_body) {
  const TrackedScan tracked = tracker_.update(scan, T_odom_body);
  if (tracked.is_keyframe) add_keyframe(scan, tracked);
  path_.push_back({static_cast<int>(keyframes_.size()) - 1, tracked.T_local_body});
  return graph_.T_map_node.back() * (keyframes_.back().T_local_body.inverse() * tracked.T_local_body);
}

void GraphSlam::add_keyframe(const LevelScan& scan, const TrackedScan& tracked) {
  const int node = static_cast<int>(keyframes_.size());
  if (node == 0) {
    graph_.T_map_node.push_back(tracked.T_local_body);
  } else {
    const Keyframe& before = keyframes_.back();
    const Pose2 T_before_node = before.T_local_body.inverse() * tracked.T_local_body;
    graph_.T_map_node.push_back(graph_.T_map_node.back() * T_before_node);
    const PoseGaussian motion = predict_motion({}, T_before_node, to_seconds(scan.stamp - before.scan.stamp), settings_.tracking.motion);
    graph_.edges.push_back({.from = node - 1, .to = node, .T_from_to = T_before_node, .information = motion.covariance.inverse(), .kind = PoseGraphEdge::Kind::kOdometry});
    const int first = submaps_[static_cast<std::size_t>(tracked.submap)].first;
    if (tracked.matched_share > 0.0 && first != node) {
      const Pose2& T_local_first = keyframes_[static_cast<std::size_t>(first)].T_local_body;
      graph_.edges.push_back({.from = first,
                              .to = node,
                              .T_from_to = T_local_first.inverse() * tracked.T_local_body,
                              .information = edge_information(tracked.match_information, T_local_first),
                              .kind = PoseGraphEdge::Kind::kMatch});
    }
  }
  keyframes_.push_back({scan, tracked.T_local_body});
  if (tracked.is_submap_start) submaps_.push_back({.first = node, .last = node});
  for (std::size_t s = static_cast<std::size_t>(tracked.submap); s < submaps_.size(); ++s) submaps_[s].last = node;
  while (finished_submaps_ < tracked.submap) close_loops(finished_submaps_++);
}

Eigen::Matrix3d GraphSlam::edge_information(const Eigen::Matrix3d& match_information, const Pose2& T_map_from) const {
  const Eigen::Matrix3d in_from = turned(settings_.tracking.likelihood_gain * match_information, -T_map_from.yaw);
  const Eigen::Matrix3d loose = Eigen::Vector3d(1e-2, 1e-2, 1e-2).asDiagonal();  // 10 m and 10 rad, where the match says nothing
  const Eigen::Matrix3d systematic =
      Eigen::Vector3d(settings_.edge_std_m * settings_.edge_std_m, settings_.edge_std_m * settings_.edge_std_m, settings_.edge_std_rad * settings_.edge_std_rad).asDiagonal();
  const Eigen::Matrix3d information = ((in_from + loose).inverse() + systematic).inverse();
  return 0.5 * (information + information.transpose());
}

Eigen::Vector2d GraphSlam::middle_of(int submap) const {
  const Submap& range = submaps_[static_cast<std::size_t>(submap)];
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = range.first; k <= range.last; ++k) sum += graph_.T_map_node[static_cast<std::size_t>(k)].position();
  return sum / (range.last - range.first + 1);
}

// By the way from each to the next, on which the tracker drifts, and by the loops that are closed.
std::vector<PoseGaussian> GraphSlam::positions_around(int submap) const {
  std::vector<Pose2> T_map_submaps;
  for (int s = 0; s < finished_submaps_; ++s) T_map_submaps.push_back(T_map_submap(s));
  std::vector<UncertainWay> ways;
  for (int s = 0; s + 1 < finished_submaps_; ++s) ways.push_back({.from = s, .to = s + 1, .covariance = drift_after(s)});
  for (const LoopEdge& loop : loops_) {
    ways.push_back({.from = loop.target, .to = loop.source, .covariance = graph_.edges[static_cast<std::size_t>(loop.edge)].information.inverse()});
  }
  return positions_from(submap, T_map_submaps, ways);
}

// Of the next submap's place as seen from this one.
Eigen::Matrix3d GraphSlam::drift_after(int submap) const {
  double length_m = 0.0, turn_rad = 0.0;
  for (int k = submaps_[static_cast<std::size_t>(submap)].first; k < submaps_[static_cast<std::size_t>(submap) + 1].first; ++k) {
    const Pose2 step = keyframes_[static_cast<std::size_t>(k)].T_local_body.inverse() * keyframes_[static_cast<std::size_t>(k) + 1].T_local_body;
    length_m += step.position().norm();
    turn_rad += std::abs(step.yaw);
  }
  const double std_m = settings_.drift_std_m_per_m * length_m, std_rad = settings_.drift_std_rad_per_m * length_m + settings_.drift_std_rad_per_rad * turn_rad;
  return Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal();
}

// Older ones, nearest first, as far as drift may have taken this one.
std::vector<int> GraphSlam::submaps_near(int source, const std::vector<PoseGaussian>& around) const {
  const Eigen::Vector2d middle = middle_of(source);
  std::vector<std::pair<double, int>> near;  // by how far they are
  for (int target = 0; target < source; ++target) {
    if (submaps_[static_cast<std::size_t>(target)].last >= submaps_[static_cast<std::size_t>(source)].first) continue;  // neighbours in time
    const Eigen::Matrix3d& covariance = around[static_cast<std::size_t>(target)].covariance;
    const double reach_m = settings_.max_loop_distance_m + 2.0 * std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
    const double distance_m = (middle_of(target) - middle).norm();
    if (distance_m < reach_m) near.push_back({distance_m, target});
  }
  return nearest(near, settings_.max_loop_candidates);
}

void GraphSlam::close_loops(int source) {
  const std::vector<PoseGaussian> around = positions_around(source);
  bool has_closed = false;
  for (const int target : submaps_near(source, around)) {
    const PoseGaussian prediction = inverse_of(around[static_cast<std::size_t>(target)]);  // of the source in the target
    const SubmapMatchResult result = match_submaps(*drawn(target), *drawn(source), prediction, settings_.loops, settings_.tracking.matching);
    loop_counts_.add(result.failure);
    if (!result.match) continue;
    has_closed = true;
    loops_.push_back({.target = target, .source = source, .edge = static_cast<int>(graph_.edges.size())});
    graph_.edges.push_back({.from = submaps_[static_cast<std::size_t>(target)].first,
                            .to = submaps_[static_cast<std::size_t>(source)].first,
                            .T_from_to = result.match->T_target_source,
                            .information = edge_information(result.match->information, {}),
                            .kind = PoseGraphEdge::Kind::kLoop});
  }
  if (has_closed) solve(graph_, settings_.solver);
}

std::shared_ptr<const DrawnSubmap> GraphSlam::drawn(int submap) {
  return cache_.get(submap, [&] {
    return std::make_shared<const DrawnSubmap>(submaps_[static_cast<std::size_t>(submap)], keyframes_, graph_.T_map_node, drawing_);
  });
}

void GraphSlam::finish() {
  while (finished_submaps_ < static_cast<int>(submaps_.size())) close_loops(finished_submaps_++);
  const std::size_t num_edges = graph_.edges.size();
  for (int round = 0; round < settings_.refinement_rounds; ++round) {
    graph_.edges.resize(num_edges);
    cache_.clear();
    refine();
    solve(graph_, settings_.solver);
  }
}

// [submap]: the keyframes that lie within its reach and are no part of it.
std::vector<std::vector<int>> GraphSlam::keyframes_around_submaps() const {
  std::vector<Eigen::Vector2d> middles;
  for (int s = 0; s < static_cast<int>(submaps_.size()); ++s) middles.push_back(middle_of(s));
  std::vector<std::vector<int>> keyframes_of(submaps_.size());
  for (int k = 0; k < static_cast<int>(keyframes_.size()); ++k) {
    std::vector<std::pair<double, int>> near;
    for (std::size_t s = 0; s < submaps_.size(); ++s) {
      if (k >= submaps_[s].first && k <= submaps_[s].last) continue;
      const double distance_m = (middles[s] - graph_.T_map_node[static_cast<std::size_t>(k)].position()).norm();
      if (distance_m < settings_.max_loop_distance_m) near.push_back({distance_m, static_cast<int>(s)});
    }
    for (const int s : nearest(near, settings_.max_refinement_submaps)) keyframes_of[static_cast<std::size_t>(s)].push_back(k);
  }
  return keyframes_of;
}

// Submap by submap, so that each is drawn once.
void GraphSlam::refine() {
  const std::vector<std::vector<int>> keyframes_of = keyframes_around_submaps();
  for (int s = 0; s < static_cast<int>(submaps_.size()); ++s) {
    if (keyframes_of[static_cast<std::size_t>(s)].empty()) continue;
    const std::shared_ptr<const DrawnSubmap> submap = drawn(s);
    const Pose2 T_submap_map = T_map_submap(s).inverse();
    for (const int k : keyframes_of[static_cast<std::size_t>(s)]) {
      const Pose2 T_submap_node = T_submap_map * graph_.T_map_node[static_cast<std::size_t>(k)];
      const std::optional<MatchResult> match = refined(*submap, keyframes_[static_cast<std::size_t>(k)], T_submap_node);
      if (!match) continue;
      graph_.edges.push_back({.from = submaps_[static_cast<std::size_t>(s)].first,
                              .to = k,
                              .T_from_to = match->T_map_body,
                              .information = edge_information(match->information, {}),
                              .kind = PoseGraphEdge::Kind::kLoop});
    }
  }
}

// A keyframe matched with a submap that lies nearly right.
std::optional<MatchResult> GraphSlam::refined(const DrawnSubmap& submap, const Keyframe& keyframe, const Pose2& T_submap_body) const {
  const ScanMatcherSettings& matching = settings_.tracking.matching;
  const std::vector<MatchPoint> points = select_match_points(keyframe.scan, matching.point_spacing_m, matching.max_points);
  const std::optional<MatchResult> match = match_scan(submap.map(), points, T_submap_body, start_of_match(T_submap_body), matching);
  if (!match || match->matched_share < settings_.min_refinement_share) return std::nullopt;
  const Pose2 moved = T_submap_body.inverse() * match->T_map_body;
  if (moved.position().norm() > settings_.max_refinement_m || std::abs(moved.yaw) > settings_.max_refinement_rad) return std::nullopt;
  return match;
}

// A scan between two keyframes is moved with both, by how near it is to each.
std::vector<Pose2> GraphSlam::path() const {
  std::vector<Pose2> T_map_body;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const auto before = static_cast<std::size_t>(path_[i].keyframe);
    const Pose2 from_before = graph_.T_map_node[before] * (keyframes_[before].T_local_body.inverse() * path_[i].T_local_body);
    const std::size_t after = before + 1;
    if (after >= keyframes_.size()) {
      T_map_body.push_back(from_before);
      continue;
    }
    const Pose2 from_after = graph_.T_map_node[after] * (keyframes_[after].T_local_body.inverse() * path_[i].T_local_body);
    const auto distance = [&](std::size_t k) {
      const Pose2 offset = keyframes_[k].T_local_body.inverse() * path_[i].T_local_body;
      return offset.position().norm() + std::abs(offset.yaw);
    };
    const double to_before = distance(before), to_after = distance(after), share = to_before + to_after > 0.0 ? to_before / (to_before + to_after) : 0.0;
    T_map_body.push_back({from_before.x + share * (from_after.x - from_before.x), from_before.y + share * (from_after.y - from_before.y),
                          wrap_angle(from_before.yaw + share * wrap_angle(from_after.yaw - from_before.yaw))});
  }
  return T_map_body;
}

OccupancyGrid GraphSlam::map() const {
  GridMap map(settings_.tracking.resolution_m, settings_.tracking.max_extent_m);
  for (std::size_t k = 0; k < keyframes_.size(); ++k) integrate_scan(keyframes_[k].scan, graph_.T_map_node[k], settings_.tracking.integration, map);
  return render_map(map, settings_.min_hits_occupied, settings_.min_hit_share_occupied);
}

}  // namespace patrol::slam
