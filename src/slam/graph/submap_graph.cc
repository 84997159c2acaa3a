#include "slam/graph/submap_graph.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace patrol::slam {
namespace {

constexpr int kLeftOut = -1;

/// Returns [keyframe]: the index of the submap that begins there, or -1.
std::vector<int> submap_beginning_at(const std::vector<Submap>& submaps, std::size_t num_keyframes) {
  std::vector<int> beginning(num_keyframes, -1);
  for (std::size_t s = 0; s < submaps.size(); ++s)
    beginning[static_cast<std::size_t>(submaps[s].first)] = static_cast<int>(s);
  return beginning;
}

/// Connects `node` to the nearest node before it that begins no submap, because an edge from the first node of a submap
/// is a match.
void connect(PoseGraph& graph, const std::vector<int>& beginning, int node, const ConnectionSettings& settings) {
  const Pose2& T_map_node = graph.T_map_node[static_cast<std::size_t>(node)];
  double nearest_m = std::numeric_limits<double>::infinity();
  int nearest = kLeftOut;
  for (int before = 0; before < node; ++before) {
    if (beginning[static_cast<std::size_t>(before)] >= 0) continue;
    const double distance_m =
        (graph.T_map_node[static_cast<std::size_t>(before)].position() - T_map_node.position()).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = before;
  }
  if (nearest == kLeftOut) return;
  const double std_m = settings.min_std_m + settings.std_m_per_m * nearest_m,
               std_rad = settings.min_std_rad + settings.std_rad_per_m * nearest_m;
  graph.edges.push_back({.from = nearest,
                         .to = node,
                         .T_from_to = graph.T_map_node[static_cast<std::size_t>(nearest)].inverse() * T_map_node,
                         .information = Eigen::Vector3d(std_m, std_m, std_rad).cwiseAbs2().cwiseInverse().asDiagonal(),
                         .kind = PoseGraphEdge::Kind::kOdometry});
}

}  // namespace

SubmapGraph make_submap_graph(std::vector<ScanGroup> scans, std::vector<Submap> submaps, PoseGraph graph) {
  const std::size_t num_nodes = graph.T_map_node.size();
  if (scans.size() != num_nodes)
    throw std::invalid_argument(fmt::format("{} keyframes, but {} nodes of the pose graph", scans.size(), num_nodes));
  std::vector<bool> is_covered(num_nodes, false);
  for (std::size_t s = 0; s < submaps.size(); ++s) {
    const Submap& submap = submaps[s];
    if (submap.first < 0 || submap.last < submap.first || submap.last >= static_cast<int>(num_nodes) ||
        (s > 0 && submap.first <= submaps[s - 1].first))
      throw std::invalid_argument(fmt::format("submap {}: invalid range of keyframes", s));
    std::fill(is_covered.begin() + submap.first, is_covered.begin() + submap.last + 1, true);
  }
  const auto uncovered = std::find(is_covered.begin(), is_covered.end(), false);
  if (uncovered != is_covered.end())
    throw std::invalid_argument(fmt::format("keyframe {} belongs to no submap", uncovered - is_covered.begin()));

  const std::vector<int> beginning = submap_beginning_at(submaps, num_nodes);
  for (PoseGraphEdge& edge : graph.edges) {
    const int s = beginning[static_cast<std::size_t>(edge.from)];
    if (s < 0) {
      edge.kind = PoseGraphEdge::Kind::kOdometry;
    } else {
      const Submap& submap = submaps[static_cast<std::size_t>(s)];
      const bool is_inside = edge.to >= submap.first && edge.to <= submap.last;
      edge.kind = is_inside ? PoseGraphEdge::Kind::kMatch : PoseGraphEdge::Kind::kLoop;
    }
  }
  SubmapGraph map{.keyframes = {}, .submaps = std::move(submaps), .graph = std::move(graph)};
  for (std::size_t k = 0; k < num_nodes; ++k)
    map.keyframes.push_back({.scans = std::move(scans[k]), .T_local_body = map.graph.T_map_node[k]});
  return map;
}

SubmapGraph with_submaps(const SubmapGraph& map, const std::vector<bool>& is_kept, const ConnectionSettings& settings) {
  std::vector<int> new_index(map.keyframes.size(), kLeftOut);
  for (std::size_t s = 0; s < map.submaps.size(); ++s) {
    if (is_kept[s]) std::fill(new_index.begin() + map.submaps[s].first, new_index.begin() + map.submaps[s].last + 1, 0);
  }
  SubmapGraph kept;
  std::vector<int> unconnected;
  for (std::size_t k = 0; k < new_index.size(); ++k) {
    if (new_index[k] == kLeftOut) continue;
    new_index[k] = static_cast<int>(kept.keyframes.size());
    if (k > 0 && new_index[k - 1] == kLeftOut) unconnected.push_back(new_index[k]);
    kept.keyframes.push_back(map.keyframes[k]);
    kept.keyframes.back().T_local_body = map.graph.T_map_node[k];
    kept.graph.T_map_node.push_back(map.graph.T_map_node[k]);
  }
  const auto index_of = [&](int node) { return new_index[static_cast<std::size_t>(node)]; };
  for (std::size_t s = 0; s < map.submaps.size(); ++s) {
    if (is_kept[s])
      kept.submaps.push_back({.first = index_of(map.submaps[s].first), .last = index_of(map.submaps[s].last)});
  }
  for (const PoseGraphEdge& edge : map.graph.edges) {
    if (index_of(edge.from) == kLeftOut || index_of(edge.to) == kLeftOut) continue;
    kept.graph.edges.push_back(edge);
    kept.graph.edges.back().from = index_of(edge.from);
    kept.graph.edges.back().to = index_of(edge.to);
  }
  const std::vector<int> beginning = submap_beginning_at(kept.submaps, kept.keyframes.size());
  for (const int node : unconnected) connect(kept.graph, beginning, node, settings);
  return kept;
}

}  // namespace patrol::slam
