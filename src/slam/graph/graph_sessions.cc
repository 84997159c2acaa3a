// Maps of several sessions in GraphSlam: locates a new session in the map of earlier ones, and selects the submaps that
// are kept for the next.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "slam/graph/graph_slam.h"
#include "slam/rigid_motion.h"
#include "slam/surface_overlap.h"

namespace patrol::slam {
namespace {

// Two submaps agree on the pose of the session within these and three standard deviations of the drift between them.
constexpr double kMaxDisagreement_m = 0.5, kMaxDisagreementRad = 0.05;
// Standard deviation of a submap that was located in the earlier map as a whole, for matches with its submaps.
constexpr double kLocatedStd_m = 0.2, kLocatedStdRad = 0.02;
constexpr double kMinLocatingScore = 0.4;  ///< minimum score of the search in the whole map
constexpr double kPathMargin_m = 10.0;     ///< margin around the earlier path
constexpr int kSameSurfaceRadius = 2;      ///< cells
/// A submap is not kept if more than this fraction of its surfaces lies in observed cells of the others, and agrees
/// there as in a loop closure.
constexpr double kMaxKnownFraction = 0.9;

/// Window that contains the positions and all angles.
SearchWindow window_around(const std::vector<Pose2>& T_map_node, std::size_t num_nodes) {
  const Pose2 T_first_map = T_map_node.front().inverse();
  Eigen::AlignedBox2d box;
  for (std::size_t k = 0; k < num_nodes; ++k) box.extend((T_first_map * T_map_node[k]).position());
  return {.T_map_center = {box.center().x(), box.center().y(), 0.0},
          .half_width_m = 0.5 * box.sizes().maxCoeff() + kPathMargin_m,
          .half_angle_rad = std::numbers::pi};
}

}  // namespace

void GraphSlam::extend(const SubmapGraph& earlier) {
  if (!path_.empty() || has_earlier_map()) throw std::logic_error("extend: the session has begun");
  keyframes_ = earlier.keyframes;
  submaps_ = earlier.submaps;
  graph_ = earlier.graph;
  first_keyframe_ = static_cast<int>(keyframes_.size());
  first_submap_ = finished_submaps_ = static_cast<int>(submaps_.size());
  is_located_ = !has_earlier_map();
}

// Searches a finished submap of this session in the earlier map, unless it overlaps the last one that was searched. Two
// submaps must agree on the pose of the session.
void GraphSlam::locate(int source) {
  const Submap& submap = submaps_[static_cast<std::size_t>(source)];
  if (submap.first <= last_located_keyframe_) return;
  last_located_keyframe_ = submap.last;
  if (!earlier_map_) {
    earlier_map_.emplace(Submap{.first = 0, .last = first_keyframe_ - 1}, keyframes_, graph_.T_map_node, rendering_);
  }
  SubmapMatcherSettings locating = settings_.loop_closure;
  locating.min_search_score = std::max(locating.min_search_score, kMinLocatingScore);
  const SubmapMatchResult found = locate_submap(
      *earlier_map_, *rendered(source), window_around(graph_.T_map_node, static_cast<std::size_t>(first_keyframe_)),
      locating, settings_.scan_odometry.matching);
  if (!found.match) return;
  const LocatedSubmap located{.submap = source,
                              .T_map_submap = graph_.T_map_node.front() * found.match->T_target_source};
  const bool is_confirmed =
      std::ranges::any_of(located_, [&](const LocatedSubmap& other) { return agree(other, located); });
  located_.push_back(located);
  if (is_confirmed) align_session(located);
}

// Returns whether two located submaps, the first of them older, have the same relative pose as in this session.
bool GraphSlam::agree(const LocatedSubmap& a, const LocatedSubmap& b) const {
  const Pose2 T_a_b = T_map_submap(a.submap).inverse() * T_map_submap(b.submap),
              difference = T_a_b.inverse() * (a.T_map_submap.inverse() * b.T_map_submap);
  const Eigen::Matrix3d drift = relative_pose_distributions(a.submap)[static_cast<std::size_t>(b.submap)].covariance;
  return difference.position().norm() < kMaxDisagreement_m + 3.0 * std::sqrt(std::max(drift(0, 0), drift(1, 1))) &&
         std::abs(difference.yaw) < kMaxDisagreementRad + 3.0 * std::sqrt(drift(2, 2));
}

// Moves this session to the pose of a located submap and closes its loops with the earlier submaps. Returns false if
// none of them matches.
bool GraphSlam::align_session(const LocatedSubmap& located) {
  const Pose2 T_map_session = located.T_map_submap * T_map_submap(located.submap).inverse();
  for (auto node = graph_.T_map_node.begin() + first_keyframe_; node != graph_.T_map_node.end(); ++node)
    *node = T_map_session * *node;
  const Eigen::Matrix3d covariance =
      Eigen::Vector3d(kLocatedStd_m, kLocatedStd_m, kLocatedStdRad).cwiseAbs2().asDiagonal();
  std::vector<PoseGaussian> around(static_cast<std::size_t>(finished_submaps_));
  for (int target = 0; target < finished_submaps_; ++target) {
    PoseGaussian& distribution = around[static_cast<std::size_t>(target)];
    distribution.mean = T_map_submap(located.submap).inverse() * T_map_submap(target);
    distribution.covariance =
        target < first_submap_
            ? covariance
            : Eigen::Matrix3d(
                  Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()).asDiagonal());  // closed before
  }
  if (!add_loops(located.submap, around)) return false;
  is_located_ = true;
  earlier_map_.reset();
  optimize();
  for (int source = first_submap_; source < finished_submaps_; ++source) {
    if (source != located.submap && add_loops(source, relative_pose_distributions(source))) optimize();
  }
  return true;
}

// At the end of a short session: located submaps that all agree suffice.
void GraphSlam::locate_by_single_submap() {
  for (const LocatedSubmap& located : located_) {
    if (!std::ranges::all_of(located_, [&](const LocatedSubmap& other) { return agree(located, other); })) return;
  }
  for (const LocatedSubmap& located : located_) {
    if (align_session(located)) return;
  }
}

void GraphSlam::remove_earlier_map() {
  std::vector<bool> is_kept(submaps_.size(), true);
  std::fill_n(is_kept.begin(), first_submap_, false);
  const std::vector<Keyframe> tracked(keyframes_.begin() + first_keyframe_, keyframes_.end());
  SubmapGraph own = with_submaps({keyframes_, submaps_, graph_}, is_kept, {});
  keyframes_ = tracked;
  submaps_ = std::move(own.submaps);
  graph_ = std::move(own.graph);
  for (TrackedPose& pose : path_) pose.keyframe -= first_keyframe_;
  first_keyframe_ = first_submap_ = 0;
  finished_submaps_ = static_cast<int>(submaps_.size());
  cache_.clear();
  incremental_map_ = IncrementalMap(rendering_);
  earlier_map_.reset();
  loops_.clear();
}

// Optimization fixes the first node only. The earlier keyframes stay where they were, as far as a rigid motion of the
// map allows.
void GraphSlam::restore_map_frame() {
  std::vector<Eigen::Vector2d> before, after;
  for (std::size_t k = 0; k < static_cast<std::size_t>(first_keyframe_); ++k) {
    before.push_back(keyframes_[k].T_local_body.position());
    after.push_back(graph_.T_map_node[k].position());
  }
  const Pose2 T_before_after = fit_rigid_motion(before, after);
  for (Pose2& T_map_node : graph_.T_map_node) T_map_node = T_before_after * T_map_node;
}

// A submap of this session is kept if it shows places that neither the earlier map nor the kept ones before it show, or
// places that have changed.
std::vector<bool> GraphSlam::kept_submaps() const {
  std::vector<bool> is_kept(submaps_.size(), true);
  if (!has_earlier_map()) return is_kept;
  GridMap known(rendering_.resolution_m, rendering_.max_extent_m);
  const auto add_to_known = [&](int first, int last) {
    for (int k = first; k <= last; ++k) {
      const auto i = static_cast<std::size_t>(k);
      keyframes_[i].scans.integrate(graph_.T_map_node[i], rendering_.integration, known);
    }
  };
  add_to_known(0, first_keyframe_ - 1);
  for (int s = first_submap_; s < static_cast<int>(submaps_.size()); ++s) {
    const Submap& submap = submaps_[static_cast<std::size_t>(s)];
    const RenderedSubmap rendered(submap, keyframes_, graph_.T_map_node, rendering_);
    const SurfaceOverlap overlap =
        measure_overlap(known, rendered.surface_points(), T_map_submap(s), kSameSurfaceRadius);
    is_kept[static_cast<std::size_t>(s)] =
        overlap.overlap_ratio() < kMaxKnownFraction || overlap.inlier_ratio() < settings_.loop_closure.min_inlier_ratio;
    if (is_kept[static_cast<std::size_t>(s)]) add_to_known(submap.first, submap.last);
  }
  return is_kept;
}

SubmapGraph GraphSlam::submap_graph() const {
  return with_submaps({keyframes_, submaps_, graph_}, kept_submaps(),
                      {.std_m_per_m = settings_.drift_std_m_per_m,
                       .std_rad_per_m = settings_.drift_std_rad_per_m,
                       .min_std_m = settings_.edge_std_m,
                       .min_std_rad = settings_.edge_std_rad});
}

}  // namespace patrol::slam
