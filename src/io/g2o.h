#pragma once

#include <filesystem>
#include <string>

#include "core/pose_graph.h"

namespace patrol::io {

/// Pose graphs in g2o's text (Kuemmerle et al., "g2o: a general framework for graph optimization", ICRA 2011), in the plane:
///
///   VERTEX_SE2 id x y yaw
///   EDGE_SE2 from to x y yaw I11 I12 I13 I22 I23 I33     the upper half of the information
///   FIX id ...
///
/// Node i is the file's i-th vertex, whatever its id; an edge may stand before its vertices. An edge from one node to the next is
/// odometry, every other a loop: the file does not say. FIX is checked, and not kept: a graph's first node holds it.
///
/// Throws InputError with file and line for what is none of these, an id that is there twice or not at all, an edge from a node to
/// itself, and an information that is not positive definite.
PoseGraph load_g2o(const std::filesystem::path& file);

/// Numbers in the fewest digits that read back as the same. Ids are the nodes' places, the first is fixed.
std::string to_g2o(const PoseGraph& graph);
void save_g2o(const std::filesystem::path& file, const PoseGraph& graph);

}  // namespace patrol::io
