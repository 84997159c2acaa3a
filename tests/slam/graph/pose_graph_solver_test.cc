#include "slam/graph/pose_graph_solver.h"

#include <chrono>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::pose_graph_solver_test {
namespace {

using test::Pose2Near;
using Kind = PoseGraphEdge::Kind;

/// As many nodes round a circle of 10 m, looking ahead; edges of odometry from one to the next, without error.
PoseGraph make_ring(int num_nodes) {
  PoseGraph graph;
  for (int i = 0; i < num_nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / num_nodes;
    graph.T_map_node.push_back(
        {10.0 * std::cos(angle), 10.0 * std::sin(angle), wrap_angle(angle + 0.5 * std::numbers::pi)});
  }
  for (int i = 0; i + 1 < num_nodes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    graph.edges.push_back({.from = i,
                           .to = i + 1,
                           .T_from_to = graph.T_map_node[k].inverse() * graph.T_map_node[k + 1],
                           .information = Eigen::Vector3d(400.0, 400.0, 1e4).asDiagonal(),
                           .kind = Kind::kOdometry});
  }
  return graph;
}

PoseGraphEdge true_edge(const PoseGraph& truth, int from, int to, Kind kind) {
  return {.from = from,
          .to = to,
          .T_from_to = truth.T_map_node[static_cast<std::size_t>(from)].inverse() *
                       truth.T_map_node[static_cast<std::size_t>(to)],
          .information = Eigen::Vector3d(1e4, 1e4, 1e6).asDiagonal(),
          .kind = kind};
}

/// Nodes as the edges' odometry with noise would have them.
void shake(PoseGraph& graph, double std_m, double std_rad) {
  const RandomStream noise(1, "test/shake");
  Pose2 pose = graph.T_map_node[0];
  for (std::size_t i = 0; i + 1 < graph.T_map_node.size(); ++i) {
    const auto unit = noise.normals(i);
    const Pose2& step = graph.edges[i].T_from_to;
    pose = pose * Pose2{step.x + std_m * unit[0], step.y + std_m * unit[1], step.yaw + std_rad * unit[2]};
    graph.T_map_node[i + 1] = pose;
  }
}

// Steps of 1 m and 1 m, and the whole measured as 2.3 m with the same weight: each takes a third of the 0.3 m.
TEST(SolvePoseGraph, ThreeMeasurementsShareTheirContradictionEqually) {
  PoseGraph graph{.T_map_node = {{}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}},
                  .edges = {{.from = 0, .to = 1, .T_from_to = {1.0, 0.0, 0.0}},
                            {.from = 1, .to = 2, .T_from_to = {1.0, 0.0, 0.0}},
                            {.from = 0, .to = 2, .T_from_to = {2.3, 0.0, 0.0}}}};
  const PoseGraphSolution solution = solve(graph, {});
  EXPECT_TRUE(solution.converged);
  EXPECT_THAT(graph.T_map_node[1], Pose2Near(Pose2{1.1, 0.0, 0.0}, 1e-6, 1e-9));
  EXPECT_THAT(graph.T_map_node[2], Pose2Near(Pose2{2.2, 0.0, 0.0}, 1e-6, 1e-9));
  EXPECT_NEAR(solution.initial_cost, 0.5 * 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(solution.final_cost, 0.5 * 3.0 * 0.1 * 0.1, 1e-9);
}

TEST(SolvePoseGraph, EdgesWithoutErrorBringARingOfFortyBackFromMetersOff) {
  const PoseGraph truth = make_ring(40);
  PoseGraph graph = truth;
  graph.edges.push_back(true_edge(truth, 39, 0, Kind::kMatch));
  shake(graph, 0.2, 0.05);
  EXPECT_GT((graph.T_map_node[39].position() - truth.T_map_node[39].position()).norm(), 2.0);
  solve(graph, {});
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_THAT(graph.T_map_node[i], Pose2Near(truth.T_map_node[i], 1e-5, 1e-6)) << i;
}

TEST(SolvePoseGraph, TheFirstNodeStaysWhereItIs) {
  PoseGraph graph = make_ring(10);
  const Pose2 T_turned_map{3.0, -2.0, 1.0};
  for (Pose2& node : graph.T_map_node) node = T_turned_map * node;
  const Pose2 first = graph.T_map_node[0];
  graph.edges.push_back({.from = 0, .to = 9, .T_from_to = {1.0, 1.0, 1.0}, .kind = Kind::kLoop});
  solve(graph, {});
  EXPECT_THAT(graph.T_map_node[0], Pose2Near(first, 0.0, 1e-15));
}

// Five loop closures are right, one joins two places 20 m apart. As a plain edge it tears the ring apart.
TEST(SolvePoseGraph, OneFalseClosureAmongSixMovesNoNodeByTwoCentimetersAndWithoutItsKernelByMeters) {
  const PoseGraph truth = make_ring(40);
  for (const Kind kind : {Kind::kLoop, Kind::kMatch}) {
    PoseGraph graph = truth;
    for (const int from : {39, 38, 37, 36, 35}) graph.edges.push_back(true_edge(truth, from, 39 - from, Kind::kLoop));
    PoseGraphEdge wrong = true_edge(truth, 10, 11, kind);
    wrong.to = 30;
    graph.edges.push_back(wrong);
    solve(graph, {});
    double far_m = 0.0;
    for (std::size_t i = 0; i < 40; ++i)
      far_m = std::max(far_m, (graph.T_map_node[i].position() - truth.T_map_node[i].position()).norm());
    if (kind == Kind::kLoop) {
      EXPECT_LT(far_m, 0.02);
      EXPECT_GT(squared_residual(graph.edges.back(), graph.T_map_node), 1e5);
    } else {
      EXPECT_GT(far_m, 2.0);
    }
  }
}

TEST(SolvePoseGraph, AnEdgeToANodeThatIsNotThereThrows) {
  PoseGraph graph = make_ring(3);
  graph.edges.push_back({.from = 0, .to = 3, .T_from_to = {}});
  EXPECT_THROW(solve(graph, {}), std::invalid_argument);
}

/// A meter apart along x; edges say `step_m`.
PoseGraph make_line(int num_nodes, double step_m) {
  PoseGraph graph;
  for (int i = 0; i < num_nodes; ++i) {
    graph.T_map_node.push_back({static_cast<double>(i), 0.0, 0.0});
    if (i > 0)
      graph.edges.push_back({.from = i - 1,
                             .to = i,
                             .T_from_to = {step_m, 0.0, 0.0},
                             .information = Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal(),
                             .kind = Kind::kOdometry});
  }
  return graph;
}

RangeMeasurement clear_range(const Pose2& T_map_body, const UwbAnchor& anchor) {
  const Eigen::Vector3d antenna = Eigen::Vector3d::Zero();
  return {.anchor = anchor,
          .range_m = predict_uwb_range(anchor, T_map_body, antenna, {}).range_m,
          .T_odom_body = {},
          .p_level_antenna = antenna};
}

SurveyFactors with_known_delays(double range_std_m) {
  return {.ranges = RangeFactors({.range_std_m = range_std_m, .common_std_m = 0.0, .anchor_delay_std_m = 1e-5}),
          .positions = PositionFactors({.survey_position_std_m = 1e-3, .survey_yaw_std_rad = 1e-4})};
}

// Ten steps that odometry has 1.01 m long; at every node a range of ten readings to an anchor ahead.
TEST(SolvePoseGraph, RangesAlongALineHoldItWhereOdometryIsOnePercentTooLong) {
  PoseGraph graph = make_line(11, 1.01);
  const PoseGraph truth = graph;
  SurveyFactors survey = with_known_delays(0.02);
  for (int i = 1; i < 11; ++i) {
    const Pose2& node = truth.T_map_node[static_cast<std::size_t>(i)];
    for (int reading = 0; reading < 10; ++reading)
      survey.ranges.add(i, node, {}, clear_range(node, {.number = 1, .p_m = {30.0, 0.0, 0.0}}));
  }
  solve(graph, {}, survey);
  EXPECT_NEAR(graph.T_map_node[5].x, 5.0, 0.001);
  EXPECT_NEAR(graph.T_map_node[10].x, 10.0, 0.005);
  solve(graph, {});
  EXPECT_NEAR(graph.T_map_node[10].x, 10.1, 1e-6);
}

// One of six went round a corner and is 8 m too long.
TEST(SolvePoseGraph, ARangeThatIsFarTooLongIsDownweighted) {
  PoseGraph graph = make_line(7, 1.0);
  SurveyFactors survey = with_known_delays(0.1);
  for (int i = 1; i < 7; ++i) {
    RangeMeasurement measurement =
        clear_range(graph.T_map_node[static_cast<std::size_t>(i)], {.number = 1, .p_m = {-20.0, 0.0, 0.0}});
    if (i == 3) measurement.range_m += 8.0;
    survey.ranges.add(i, graph.T_map_node[static_cast<std::size_t>(i)], {}, measurement);
  }
  solve(graph, {}, survey);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(graph.T_map_node[static_cast<std::size_t>(i)].x, i, 0.01) << i;
}

// In the middle of a line whose ends are known the tracks slip by 0.5 m forward and 0.5 m back. Ranges to an anchor
// ahead are 0.2 m too long, those to one behind 0.2 m too short: without delays they would move the line.
TEST(SolvePoseGraph, RangesHoldALineAlthoughTheirAnchorsHaveDelays) {
  PoseGraph graph = make_line(21, 1.0);
  for (PoseGraphEdge& edge : graph.edges) edge.information = Eigen::Vector3d(25.0, 1e4, 1e4).asDiagonal();
  graph.edges.push_back(
      {.from = 0, .to = 20, .T_from_to = {20.0, 0.0, 0.0}, .information = 1e6 * Eigen::Matrix3d::Identity()});
  const PoseGraph truth = graph;
  graph.edges[5].T_from_to.x += 0.5;
  graph.edges[15].T_from_to.x -= 0.5;
  const auto solved_with = [&](double anchor_delay_std_m, SurveyFactors& survey) {
    PoseGraph solved = graph;
    survey.ranges = RangeFactors({.range_std_m = 0.05, .common_std_m = 0.0, .anchor_delay_std_m = anchor_delay_std_m});
    for (int i = 0; i <= 20; ++i) {
      const Pose2& node = truth.T_map_node[static_cast<std::size_t>(i)];
      for (const auto& [number, x_m, delay_m] : {std::tuple{1, 30.0, 0.2}, std::tuple{2, -10.0, -0.2}}) {
        RangeMeasurement measurement = clear_range(node, {.number = number, .p_m = {x_m, 0.0, 0.0}});
        measurement.range_m += delay_m;
        survey.ranges.add(i, node, {}, measurement);
      }
    }
    solve(solved, {}, survey);
    return std::abs(solved.T_map_node[10].x - 10.0);
  };
  SurveyFactors survey, without_delays;
  EXPECT_LT(solved_with(0.2, survey), 0.06);
  EXPECT_NEAR(survey.ranges.delay_m(1), 0.2, 0.04);
  EXPECT_NEAR(survey.ranges.delay_m(2), -0.2, 0.04);
  EXPECT_GT(solved_with(1e-5, without_delays), 0.12);
}

// The line bends to the left by 0.1 degrees a meter, and survey is turned by 0.5 degrees.
TEST(SolvePoseGraph, PositionsStraightenABentLineAndFindTheSurvey) {
  PoseGraph graph = make_line(61, 1.0);
  const PoseGraph truth = graph;
  for (PoseGraphEdge& edge : graph.edges) {
    edge.T_from_to.yaw = to_rad(0.1);
    edge.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
  }
  const Pose2 T_survey_map{0.03, -0.02, to_rad(0.5)};
  SurveyFactors survey;
  for (int i = 0; i < 61; ++i) {
    const Eigen::Vector2d p_survey = T_survey_map * truth.T_map_node[static_cast<std::size_t>(i)].position();
    survey.positions.add(
        i, {},
        {.stamp = std::chrono::seconds(i), .p_survey_antenna = p_survey, .std_m = 0.01, .correlation_time_s = 20.0});
  }
  PoseGraph without = graph;
  solve(without, {});
  EXPECT_GT((without.T_map_node[60].position() - truth.T_map_node[60].position()).norm(), 2.0);
  solve(graph, {}, survey);
  for (std::size_t i = 0; i < 61; ++i) {
    const Eigen::Vector2d p_survey = survey.positions.T_survey_map() * graph.T_map_node[i].position();
    EXPECT_LT((p_survey - T_survey_map * truth.T_map_node[i].position()).norm(), 0.04) << i;
  }
}

// Odometry says 1.1 m; nodes 0 to 4 stay at 0 ... 4 m, those from 5 on follow.
TEST(SolvePoseGraph, NodesBeforeTheFirstFreeOneAreFixedAndTheOthersAreSolved) {
  PoseGraph graph = make_line(8, 1.1);
  SurveyFactors no_factors;
  solve(graph, {}, no_factors, 5);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(graph.T_map_node[static_cast<std::size_t>(i)].x, i);
  for (int i = 5; i < 8; ++i) EXPECT_NEAR(graph.T_map_node[static_cast<std::size_t>(i)].x, 4.0 + 1.1 * (i - 4), 1e-6);
}

TEST(EdgeResidual, IsInTheFrameOfItsFirstNodeAndWrapsTheAngle) {
  const std::vector<Pose2> nodes = {{1.0, 1.0, 0.5 * std::numbers::pi}, {1.0, 4.0, -3.0}};
  const PoseGraphEdge edge{
      .from = 0, .to = 1, .T_from_to = {2.5, 0.1, 1.7}, .information = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal()};
  const Eigen::Vector3d error = edge_residual(edge, nodes);
  const double yaw = 2.0 * std::numbers::pi - 3.0 - 0.5 * std::numbers::pi - 1.7;
  EXPECT_LT((error - Eigen::Vector3d(0.5, -0.1, yaw)).norm(), 1e-12);
  EXPECT_NEAR(squared_residual(edge, nodes), 0.25 + 4.0 * 0.01 + 9.0 * yaw * yaw, 1e-12);
}

}  // namespace
}  // namespace patrol::slam::pose_graph_solver_test
