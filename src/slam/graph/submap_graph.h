#pragma once

#include <vector>

#include "core/pose_graph.h"
#include "slam/graph/submap.h"

namespace patrol::slam {

/// Map of GraphSlam that a later session can extend.
struct SubmapGraph {
  std::vector<Keyframe> keyframes;  ///< [node of the graph]; T_local_body is T_map_node
  std::vector<Submap> submaps;      ///< ascending; each keyframe belongs to at least one
  PoseGraph graph;
};

/// Builds the map from the scans of its nodes. Sets the kinds of the edges, which files do not contain: edges from the
/// first node of a submap go to its own keyframes (matches) or to others (loop closures); all others are odometry.
/// Throws std::invalid_argument, with a message for users, if the numbers of nodes differ, if a submap has no
/// keyframes, or if a keyframe belongs to no submap.
SubmapGraph make_submap_graph(std::vector<ScanGroup> scans, std::vector<Submap> submaps, PoseGraph graph);

/// Standard deviations of a connection: a constant part, and a part in proportion to the distance of its keyframes.
struct ConnectionSettings {
  double std_m_per_m = 0.02, std_rad_per_m = 0.004;
  double min_std_m = 0.01, min_std_rad = 0.001;
};
/// Returns the map with the kept submaps and their keyframes only, `is_kept` [submap]. A kept keyframe whose
/// predecessor is left out is connected to the nearest kept one before it.
SubmapGraph with_submaps(const SubmapGraph& map, const std::vector<bool>& is_kept, const ConnectionSettings& settings);

}  // namespace patrol::slam
