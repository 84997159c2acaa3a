#include "app/study/loop_closure_accuracy.h"

#include <gtest/gtest.h>

namespace patrol::app::loop_closure_accuracy_test {
namespace {

/// Out 40 m and back, a node every 10 m: nodes 5 to 8 stand where 3 to 0 stood.
std::vector<Pose2> out_and_back() {
  std::vector<Pose2> nodes;
  for (const double x : {0.0, 10.0, 20.0, 30.0, 40.0}) nodes.push_back({x, 0.0, 0.0});
  for (const double x : {30.0, 20.0, 10.0, 0.0}) nodes.push_back({x, 0.0, std::numbers::pi});
  return nodes;
}

PoseGraphEdge edge(const std::vector<Pose2>& nodes, int from, int to, double error_m = 0.0,
                   PoseGraphEdge::Kind kind = PoseGraphEdge::Kind::kLoop) {
  const Pose2 T_from_to = nodes[static_cast<std::size_t>(from)].inverse() * nodes[static_cast<std::size_t>(to)];
  return {.from = from,
          .to = to,
          .T_from_to = Pose2{T_from_to.x + error_m, T_from_to.y, T_from_to.yaw},
          .information = Eigen::Matrix3d::Identity(),
          .kind = kind};
}

TEST(EvaluateLoopClosures, OfThreeClosuresOneFalseTheOthersAreTwoThirds) {
  const std::vector<Pose2> nodes = out_and_back();
  const LoopClosureAccuracy truth = evaluate_loop_closures(
      {.T_map_node = nodes, .edges = {edge(nodes, 1, 7), edge(nodes, 8, 0, 0.2), edge(nodes, 2, 6, 10.0)}}, nodes);
  EXPECT_EQ(truth.right, 2U);
  EXPECT_EQ(truth.wrong, 1U);
  EXPECT_DOUBLE_EQ(truth.precision(), 2.0 / 3.0);
}

// 6 came back 40 m after 2, 7 60 m after 1, 8 80 m after 0; 5 only 20 m after 3.
TEST(EvaluateLoopClosures, RecallIsOfTheNodesThatReturned) {
  const std::vector<Pose2> nodes = out_and_back();
  const LoopClosureAccuracy truth = evaluate_loop_closures(
      {.T_map_node = nodes, .edges = {edge(nodes, 1, 7), edge(nodes, 3, 5), edge(nodes, 2, 6, 10.0)}}, nodes);
  EXPECT_EQ(truth.returns, 3U);
  EXPECT_EQ(truth.closed, 1U);
  EXPECT_DOUBLE_EQ(truth.recall(), 1.0 / 3.0);
}

TEST(EvaluateLoopClosures, AnOdometryEdgeIsNoClosure) {
  const std::vector<Pose2> nodes = out_and_back();
  const LoopClosureAccuracy truth = evaluate_loop_closures(
      {.T_map_node = nodes, .edges = {edge(nodes, 3, 4, 5.0), edge(nodes, 0, 8, 5.0, PoseGraphEdge::Kind::kMatch)}},
      nodes);
  EXPECT_EQ(truth.right + truth.wrong, 0U);
  EXPECT_EQ(truth.precision(), 1.0);
}

TEST(EvaluateLoopClosures, ARotatedClosureIsWrong) {
  const std::vector<Pose2> nodes = out_and_back();
  PoseGraphEdge turned = edge(nodes, 1, 7);
  turned.T_from_to.yaw = wrap_angle(turned.T_from_to.yaw + 0.06);
  EXPECT_EQ(evaluate_loop_closures({.T_map_node = nodes, .edges = {turned}}, nodes).wrong, 1U);
}

}  // namespace
}  // namespace patrol::app::loop_closure_accuracy_test
