// Final optimization of GraphSlam: matches every keyframe with the submaps around it.
#include <algorithm>
#include <cmath>

#include "slam/graph/graph_slam.h"
#include "slam/graph/nearest.h"

namespace patrol::slam {

void GraphSlam::finish() {
  while (finished_submaps_ < static_cast<int>(submaps_.size())) close_loops(finished_submaps_++);
  if (!is_located_) locate_by_single_submap();
  if (!is_located_) remove_earlier_map();
  // The refinement of earlier sessions is repeated.
  std::erase_if(graph_.edges, [&](const PoseGraphEdge& edge) {
    return edge.kind == PoseGraphEdge::Kind::kLoop && std::max(edge.from, edge.to) < first_keyframe_;
  });
  const std::size_t num_edges = graph_.edges.size();
  for (int round = 0; round < settings_.refinement_iterations; ++round) {
    graph_.edges.resize(num_edges);
    cache_.clear();
    refine();
    optimize();
  }
  if (has_earlier_map()) restore_map_frame();
  is_finished_ = true;
}

// Returns [submap]: the keyframes within the search radius that are not part of the submap. Those of earlier sessions
// are matched with earlier submaps only, because the submaps of this session may not be kept.
std::vector<std::vector<int>> GraphSlam::keyframes_around_submaps() const {
  std::vector<Eigen::Vector2d> centers;
  for (int s = 0; s < static_cast<int>(submaps_.size()); ++s) centers.push_back(submap_center(s));
  std::vector<std::vector<int>> keyframes_by_submap(submaps_.size());
  for (int k = 0; k < static_cast<int>(keyframes_.size()); ++k) {
    std::vector<std::pair<double, int>> near;
    for (std::size_t s = 0; s < submaps_.size(); ++s) {
      if (k >= submaps_[s].first && k <= submaps_[s].last) continue;
      if (k < first_keyframe_ && submaps_[s].first >= first_keyframe_) continue;
      const double distance_m = (centers[s] - graph_.T_map_node[static_cast<std::size_t>(k)].position()).norm();
      if (distance_m < settings_.max_loop_distance_m) near.emplace_back(distance_m, static_cast<int>(s));
    }
    for (const int s : nearest(near, settings_.max_refinement_submaps))
      keyframes_by_submap[static_cast<std::size_t>(s)].push_back(k);
  }
  return keyframes_by_submap;
}

// Iterates over submaps, so that each is rendered once.
void GraphSlam::refine() {
  const std::vector<std::vector<int>> keyframes_by_submap = keyframes_around_submaps();
  for (int s = 0; s < static_cast<int>(submaps_.size()); ++s) {
    if (keyframes_by_submap[static_cast<std::size_t>(s)].empty()) continue;
    const std::shared_ptr<const RenderedSubmap> submap = rendered(s);
    const Pose2 T_submap_map = T_map_submap(s).inverse();
    for (const int k : keyframes_by_submap[static_cast<std::size_t>(s)]) {
      const Pose2 T_submap_node = T_submap_map * graph_.T_map_node[static_cast<std::size_t>(k)];
      const std::optional<MatchResult> match = refined(*submap, keyframes_[static_cast<std::size_t>(k)], T_submap_node);
      if (!match) continue;
      graph_.edges.push_back({.from = submaps_[static_cast<std::size_t>(s)].first,
                              .to = k,
                              .T_from_to = match->T_map_body,
                              .information = match_edge_information(match->information),
                              .kind = PoseGraphEdge::Kind::kLoop});
    }
  }
}

// Matches a keyframe with a submap from a good initial pose.
std::optional<MatchResult> GraphSlam::refined(const RenderedSubmap& submap, const Keyframe& keyframe,
                                              const Pose2& T_submap_body) const {
  const ScanMatcherSettings& matching = settings_.scan_odometry.matching;
  const std::vector<MatchPoint> points = keyframe.scans.match_points(matching.point_spacing_m, matching.max_points);
  std::optional<MatchResult> match =
      match_scan(submap.map(), points, T_submap_body, match_prior(T_submap_body), matching);
  if (!match || match->inlier_ratio < settings_.min_refinement_inlier_ratio) return std::nullopt;
  const Pose2 moved = T_submap_body.inverse() * match->T_map_body;
  if (moved.position().norm() > settings_.max_refinement_m || std::abs(moved.yaw) > settings_.max_refinement_rad)
    return std::nullopt;
  return match;
}

}  // namespace patrol::slam
