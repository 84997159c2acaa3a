#include "slam/submaps/submap_rbpf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "core/random.h"
#include "slam/graph/edge_weight.h"
#include "slam/map_rendering.h"
#include "slam/submaps/pair_features.h"

namespace patrol::slam {
namespace {

/// Covariance of the next submap's first scan in the frame of the previous submap.
Eigen::Matrix3d drift_over(const SubmapBuilder& submap, const SubmapRbpfSettings& settings) {
  const double std_m = settings.drift_std_m_per_m * submap.distance_m() + 1e-3;
  const double std_rad = settings.drift_std_rad_per_m * submap.distance_m() +
                         settings.drift_std_rad_per_rad * submap.rotation_rad() + 1e-4;
  return Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal();
}

/// Derives an independent random seed for each submap.
std::uint64_t seed_of_submap(std::uint64_t seed, std::size_t submap) {
  return static_cast<std::uint64_t>(RandomStream(seed, "slam/submap").uniform(submap) * 0x1p53);
}

}  // namespace

SubmapRbpf::SubmapRbpf(const SubmapRbpfSettings& settings, BoostedStumps neighbors, std::uint64_t seed)
    : settings_(settings), neighbors_(std::move(neighbors)), seed_(seed), tracker_(settings.scan_odometry) {
  validate(settings, "slam.submap_rbpf");
}

Pose2 SubmapRbpf::update(const LevelScan& scan, const Pose2& T_odom_body) {
  const Pose2 T_local_body = tracker_.update(scan, T_odom_body).T_local_body;
  if (!builder_) {
    graph_.T_map_node.push_back({});
    begin_submap();
  }
  Pose2 T_submap_body = builder_->update(scan, T_local_body);
  if (builder_->is_full()) {
    close_submap();
    begin_submap();
    T_submap_body = builder_->update(scan, T_local_body);  // the last scan of a submap is the first of the next
  }
  ++num_scans_;
  return graph_.T_map_node.back() * T_submap_body;
}

void SubmapRbpf::begin_submap() {
  first_scans_.push_back(num_scans_);
  builder_.emplace(settings_.submaps, seed_of_submap(seed_, submaps_.size()));
}

void SubmapRbpf::close_submap() {
  add_odometry_edge(*builder_);
  Submap closed{.keyframes = {},
                .T_submap_body = builder_->path(),
                .surfaces = describe_surfaces(builder_->map(), settings_.surfaces)};
  closed.keyframes = builder_->take_keyframes();
  builder_.reset();
  submaps_.push_back(std::move(closed));
  add_loop_closures(static_cast<int>(submaps_.size()) - 1);
}

// Starts the next submap at the end of this one and adds an odometry edge.
void SubmapRbpf::add_odometry_edge(const SubmapBuilder& before) {
  const int from = static_cast<int>(graph_.T_map_node.size()) - 1;
  const Pose2 T_submap_next = before.path().back();
  const Eigen::Matrix3d drift = drift_over(before, settings_);
  graph_.T_map_node.push_back(graph_.T_map_node.back() * T_submap_next);
  graph_.edges.push_back({.from = from,
                          .to = from + 1,
                          .T_from_to = T_submap_next,
                          .information = drift.inverse(),
                          .kind = PoseGraphEdge::Kind::kOdometry});
  covariance_edges_.push_back({.from = from, .to = from + 1, .covariance = drift});
}

std::vector<PoseGaussian> SubmapRbpf::relative_pose_distributions(int submap) const {
  return shortest_path_distributions(submap, graph_.T_map_node, covariance_edges_);
}

// Returns the nearest older submaps that may be neighbors.
std::vector<int> SubmapRbpf::candidates_for(int source, const std::vector<PoseGaussian>& around) const {
  std::vector<std::pair<double, int>> near;
  for (int target = 0; target < source; ++target) {
    if (!surfaces_of(target)) continue;
    const PoseGaussian& T_source_target = around[static_cast<std::size_t>(target)];
    const SubmapDescriptor &of_source = surfaces_of(source)->descriptor, &of_target = surfaces_of(target)->descriptor;
    if (!may_be_neighbors(of_source, of_target, T_source_target)) continue;
    near.emplace_back((T_source_target.mean * of_target.center - of_source.center).norm(), target);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> candidates;
  for (std::size_t i = 0; i < std::min(near.size(), static_cast<std::size_t>(settings_.max_candidates)); ++i)
    candidates.push_back(near[i].second);
  return candidates;
}

void SubmapRbpf::add_loop_closures(int source) {
  if (!surfaces_of(source)) return;
  const std::vector<PoseGaussian> around = relative_pose_distributions(source);
  bool has_constraint = false;
  for (const int target : candidates_for(source, around)) {
    const PoseGaussian prediction = invert(around[static_cast<std::size_t>(target)]);
    const ConstraintResult result = find_constraint(*surfaces_of(target), *surfaces_of(source), prediction, neighbors_,
                                                    settings_.surfaces, settings_.constraints);
    comparisons_.push_back({.target = target, .source = source, .T_target_source = prediction, .result = result});
    if (!result.constraint) continue;
    has_constraint = true;
    const Eigen::Matrix3d information =
        edge_information(settings_.likelihood_tempering * result.constraint->information, settings_.constraint_std_m,
                         settings_.constraint_std_rad);
    graph_.edges.push_back({.from = target,
                            .to = source,
                            .T_from_to = result.constraint->T_target_source,
                            .information = information,
                            .kind = PoseGraphEdge::Kind::kLoop});
    covariance_edges_.push_back({.from = target, .to = source, .covariance = information.inverse()});
  }
  if (has_constraint) solve(graph_, settings_.solver);
}

void SubmapRbpf::finish() {
  if (!builder_) return;
  close_submap();
  graph_.T_map_node.pop_back();  // remove the node of a next submap
  graph_.edges.erase(
      std::remove_if(graph_.edges.begin(), graph_.edges.end(),
                     [&](const PoseGraphEdge& edge) { return edge.to == static_cast<int>(graph_.T_map_node.size()); }),
      graph_.edges.end());
}

// A scan that ends one submap and begins the next is assigned to the next.
std::vector<Pose2> SubmapRbpf::path() const {
  std::vector<Pose2> T_map_body;
  const auto add = [&](std::size_t submap, const std::vector<Pose2>& T_submap_body, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) T_map_body.push_back(graph_.T_map_node[submap] * T_submap_body[i]);
  };
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    const std::size_t end = s + 1 < first_scans_.size() ? first_scans_[s + 1] : num_scans_;
    add(s, submaps_[s].T_submap_body, end - first_scans_[s]);
  }
  if (builder_) add(submaps_.size(), builder_->path(), num_scans_ - first_scans_.back());
  return T_map_body;
}

OccupancyGrid SubmapRbpf::map() const {
  const GridSlamSettings& filter = settings_.submaps.filter;
  GridMap map(filter.resolution_m, settings_.scan_odometry.max_extent_m);
  for (std::size_t s = 0; s < submaps_.size(); ++s) {
    for (const Keyframe& keyframe : submaps_[s].keyframes)
      keyframe.scans.integrate(graph_.T_map_node[s] * keyframe.T_local_body, filter.integration, map);
  }
  return render_map(map, settings_.min_hits_occupied, settings_.min_occupied_hit_ratio);
}

}  // namespace patrol::slam
