#pragma once

#include <filesystem>

#include "slam/graph/submap_graph.h"

namespace patrol::app {

/// Writes a map for later sessions to a directory: `pose_graph.g2o`, `submaps.csv` (first and last keyframe of each
/// submap) and `keyframes.mcap` (the scans of each node, in order: sensor_msgs/PointCloud2 on /keyframes, fields in
/// io/ros/ros_messages.h).
void save_submap_graph(const std::filesystem::path& directory, const slam::SubmapGraph& map);

/// Reads a map that save_submap_graph has written. Throws InputError with file, and line where there is one.
slam::SubmapGraph load_submap_graph(const std::filesystem::path& directory);

}  // namespace patrol::app
