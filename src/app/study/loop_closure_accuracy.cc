#include "app/study/loop_closure_accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace patrol::app {
namespace {

constexpr double kRight_m = 0.3, kRight_rad = 0.05;
constexpr double kReturn_m = 5.0, kMinPath_m = 30.0;

bool is_right(const PoseGraphEdge& edge, const std::vector<Pose2>& T_world_node) {
  const Pose2 T_from_to =
      T_world_node[static_cast<std::size_t>(edge.from)].inverse() * T_world_node[static_cast<std::size_t>(edge.to)];
  const Pose2 off = T_from_to.inverse() * edge.T_from_to;
  return off.position().norm() < kRight_m && std::abs(off.yaw) < kRight_rad;
}

/// Distance traveled at each node, m.
std::vector<double> distances_traveled(const std::vector<Pose2>& T_world_node) {
  std::vector<double> traveled_m;
  for (std::size_t i = 0; i < T_world_node.size(); ++i) {
    traveled_m.push_back(
        i == 0 ? 0.0 : traveled_m.back() + (T_world_node[i].position() - T_world_node[i - 1].position()).norm());
  }
  return traveled_m;
}

double ratio_or_one(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 1.0;
}

}  // namespace

double LoopClosureAccuracy::precision() const { return ratio_or_one(right, right + wrong); }
double LoopClosureAccuracy::recall() const { return ratio_or_one(closed, returns); }

LoopClosureAccuracy evaluate_loop_closures(const PoseGraph& graph, const std::vector<Pose2>& T_world_node) {
  LoopClosureAccuracy accuracy;
  const std::vector<double> traveled_m = distances_traveled(T_world_node);
  std::vector<bool> is_closed(T_world_node.size(), false);
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.kind != PoseGraphEdge::Kind::kLoop || std::abs(edge.to - edge.from) <= 1) continue;
    if (!is_right(edge, T_world_node)) {
      ++accuracy.wrong;
      continue;
    }
    ++accuracy.right;
    const auto older = static_cast<std::size_t>(std::min(edge.from, edge.to)),
               newer = static_cast<std::size_t>(std::max(edge.from, edge.to));
    if (traveled_m[newer] - traveled_m[older] > kMinPath_m) is_closed[newer] = true;
  }
  for (std::size_t newer = 0; newer < T_world_node.size(); ++newer) {
    bool has_returned = false;
    for (std::size_t older = 0; older < newer && traveled_m[newer] - traveled_m[older] > kMinPath_m && !has_returned;
         ++older) {
      has_returned = (T_world_node[newer].position() - T_world_node[older].position()).norm() < kReturn_m;
    }
    accuracy.returns += has_returned ? 1 : 0;
    accuracy.closed += has_returned && is_closed[newer] ? 1 : 0;
  }
  return accuracy;
}

}  // namespace patrol::app
