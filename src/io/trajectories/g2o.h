#pragma once

#include <filesystem>
#include <string>

#include "core/pose_graph.h"

namespace patrol::io {

/// Reader and writer of planar pose graphs in the g2o text format [Kuemmerle11]:
///
///   VERTEX_SE2 id x y yaw
///   EDGE_SE2 from to x y yaw I11 I12 I13 I22 I23 I33     upper triangle of the information matrix
///   FIX id ...
///
/// Node i is the i-th vertex of the file, whatever its id; an edge may precede its vertices. The file has no edge
/// kinds: an edge between consecutive nodes is read as odometry, any other as a loop closure. FIX is checked and
/// dropped, because the first node of a graph is always fixed.
///
/// Throws InputError with file and line for any other record and a duplicate or undefined id. Also for an edge from a
/// node to itself, and for information that is not positive definite.
PoseGraph load_g2o(const std::filesystem::path& file);

/// Formats a pose graph with the fewest digits that read back identically. Ids are node indices; the first node is
/// fixed.
std::string to_g2o(const PoseGraph& graph);
void save_g2o(const std::filesystem::path& file, const PoseGraph& graph);

}  // namespace patrol::io
