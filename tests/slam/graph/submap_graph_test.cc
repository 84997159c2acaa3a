#include "slam/graph/submap_graph.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::slam::submap_graph_test {
namespace {

using Kind = PoseGraphEdge::Kind;

/// Nodes a meter apart along x, joined by odometry; submaps of `length` keyframes begin every `length` / 2.
SubmapGraph line_of_nodes(int num_nodes, int length, const std::vector<PoseGraphEdge>& more = {}) {
  PoseGraph graph;
  std::vector<ScanGroup> scans;
  for (int k = 0; k < num_nodes; ++k) {
    graph.T_map_node.push_back({static_cast<double>(k), 0.0, 0.0});
    scans.emplace_back(LevelScan{.stamp = from_seconds(k), .beams = {{.end_m = {1.0F, 0.0F}, .is_hit = true}}});
    if (k > 0) graph.edges.push_back({.from = k - 1, .to = k, .T_from_to = {1.0, 0.0, 0.0}});
  }
  graph.edges.insert(graph.edges.end(), more.begin(), more.end());
  std::vector<Submap> submaps;
  for (int first = 0; first + length <= num_nodes; first += length / 2)
    submaps.push_back({.first = first, .last = first + length - 1});
  return make_submap_graph(std::move(scans), std::move(submaps), std::move(graph));
}

PoseGraphEdge edge(int from, int to) { return {.from = from, .to = to, .T_from_to = {}}; }

TEST(SubmapGraph, TheKindOfAnEdgeFollowsFromTheSubmaps) {
  const SubmapGraph map = line_of_nodes(8, 4, {edge(2, 5), edge(2, 6), edge(1, 7)});
  ASSERT_EQ(map.submaps.size(), 3U);
  ASSERT_EQ(map.graph.edges.size(), 10U);
  EXPECT_EQ(map.graph.edges[0].kind, Kind::kMatch);     // 0 begins a submap that contains 1
  EXPECT_EQ(map.graph.edges[1].kind, Kind::kOdometry);  // 1 begins none
  EXPECT_EQ(map.graph.edges[7].kind, Kind::kMatch);     // 5 is in the submap of 2
  EXPECT_EQ(map.graph.edges[8].kind, Kind::kLoop);      // 6 is not
  EXPECT_EQ(map.graph.edges[9].kind, Kind::kOdometry);
}

TEST(SubmapGraph, AFaultyMapIsRefused) {
  const auto make = [](std::size_t num_scans, std::vector<Submap> submaps) {
    return make_submap_graph(std::vector<ScanGroup>(num_scans), std::move(submaps),
                             {.T_map_node = std::vector<Pose2>(4), .edges = {}});
  };
  EXPECT_NO_THROW(make(4, {{0, 1}, {2, 3}}));
  EXPECT_THROW(make(3, {{0, 1}, {2, 3}}), std::invalid_argument);
  EXPECT_THROW(make(4, {{0, 1}, {3, 3}}), std::invalid_argument);
  EXPECT_THROW(make(4, {{0, 1}, {2, 4}}), std::invalid_argument);
  EXPECT_THROW(make(4, {{2, 3}, {0, 1}}), std::invalid_argument);
  EXPECT_THROW(make(4, {{0, 3}, {2, 1}}), std::invalid_argument);
  EXPECT_THROW(make(4, {{-1, 3}}), std::invalid_argument);
}

TEST(WithSubmaps, WithAllOfThemTheMapIsTheSame) {
  const SubmapGraph map = line_of_nodes(8, 4);
  const SubmapGraph same = with_submaps(map, {true, true, true}, {});
  EXPECT_EQ(same.keyframes.size(), 8U);
  EXPECT_EQ(same.graph.edges.size(), map.graph.edges.size());
  EXPECT_EQ(same.submaps.back().last, 7);
}

// Submaps 0..3, 2..5, 4..7, 6..9, 8..11 without the third and fourth: keyframes 6 and 7 are left out.
TEST(WithSubmaps, AKeyframeAfterAGapIsConnectedToTheNearestBefore) {
  const SubmapGraph map = line_of_nodes(12, 4);
  ASSERT_EQ(map.submaps.size(), 5U);
  const SubmapGraph kept =
      with_submaps(map, {true, true, false, false, true},
                   {.std_m_per_m = 0.1, .std_rad_per_m = 0.01, .min_std_m = 0.2, .min_std_rad = 0.03});
  ASSERT_EQ(kept.keyframes.size(), 10U);
  EXPECT_EQ(kept.keyframes[6].scans.stamp(), from_seconds(8.0));
  EXPECT_THAT(kept.graph.T_map_node[6], test::Pose2Near(Pose2{8.0, 0.0, 0.0}, 1e-12, 1e-12));
  ASSERT_EQ(kept.submaps.size(), 3U);
  EXPECT_EQ(kept.submaps[2].first, 6);
  EXPECT_EQ(kept.submaps[2].last, 9);
  ASSERT_EQ(kept.graph.edges.size(), 5U + 3U + 1U);
  const PoseGraphEdge& connection = kept.graph.edges.back();
  EXPECT_EQ(connection.from, 5);
  EXPECT_EQ(connection.to, 6);
  EXPECT_EQ(connection.kind, Kind::kOdometry);
  EXPECT_THAT(connection.T_from_to, test::Pose2Near(Pose2{3.0, 0.0, 0.0}, 1e-12, 1e-12));
  EXPECT_NEAR(connection.information(0, 0), 1.0 / (0.5 * 0.5), 1e-9);
  EXPECT_NEAR(connection.information(2, 2), 1.0 / (0.06 * 0.06), 1e-9);
}

}  // namespace
}  // namespace patrol::slam::submap_graph_test
