// Maps of several sessions in GraphSlam.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "slam/graph/graph_slam.h"
#include "tests/slam/graph/office_world.h"

namespace patrol::slam::graph_sessions_test {
namespace {

/// Drive of one session, and its mapping after `finish`.
struct Session {
  std::vector<test::DriveStep> drive;
  GraphSlam slam{GraphSlamSettings{}};
};

Session map_session(const test::RoomWorld& world, const std::vector<Eigen::Vector2d>& corners, std::uint64_t seed,
                    const SubmapGraph* earlier = nullptr) {
  Session session{.drive = test::drive_along(corners, {})};
  if (earlier != nullptr) session.slam.extend(*earlier);
  const RandomStream noise(seed, "test/sessions");
  for (std::size_t k = 0; k < session.drive.size(); ++k) {
    const test::DriveStep& step = session.drive[k];
    session.slam.update(world.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, k), step.T_odom_body);
  }
  session.slam.finish();
  return session;
}

/// Largest error of the path, in a map that has its origin at `T_world_map`.
double max_error_m(const Session& session, const Pose2& T_world_map) {
  const std::vector<Pose2> path = session.slam.path();
  double max_m = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const Pose2 T_map_body = T_world_map.inverse() * session.drive[k].T_world_body;
    max_m = std::max(max_m, (path[k].position() - T_map_body.position()).norm());
  }
  return max_m;
}

std::vector<Eigen::Vector2d> reversed(std::vector<Eigen::Vector2d> corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

const std::vector<Eigen::Vector2d> kHalfRound = {{30.0, 25.8}, {4.2, 25.8}, {4.2, 4.2}, {20.0, 4.2}};

TEST(GraphSessions, FromAnUnknownStartASessionIsLocatedInTheEarlierMapToSixCentimeters) {
  const test::RoomWorld office = test::make_office();
  const Session first = map_session(office, test::office_rounds(1), 1);
  const SubmapGraph map = first.slam.submap_graph();
  const Pose2 T_world_map = first.drive[0].T_world_body;
  for (const auto& corners : {kHalfRound, reversed(kHalfRound)}) {
    const Session second = map_session(office, corners, 2, &map);
    ASSERT_TRUE(second.slam.is_located());
    EXPECT_LT(max_error_m(second, T_world_map), 0.06);
    EXPECT_EQ(second.slam.path().size(), second.drive.size());
    EXPECT_EQ(second.slam.node_scan_indices().size() + map.keyframes.size(), second.slam.graph().T_map_node.size());
  }
}

TEST(GraphSessions, ThatSeeNothingNewAddNoNodesAndNoErrorNineTimes) {
  const test::RoomWorld office = test::make_office();
  const Session first = map_session(office, test::office_rounds(1), 1);
  SubmapGraph map = first.slam.submap_graph();
  const std::size_t num_nodes = map.keyframes.size(), num_edges = map.graph.edges.size();
  for (std::uint64_t seed = 2; seed <= 10; ++seed) {
    const Session session = map_session(office, seed % 2 == 0 ? kHalfRound : reversed(kHalfRound), seed, &map);
    ASSERT_TRUE(session.slam.is_located()) << seed;
    EXPECT_LT(max_error_m(session, first.drive[0].T_world_body), 0.06) << seed;
    map = session.slam.submap_graph();
    EXPECT_LE(map.keyframes.size(), num_nodes + num_nodes / 20) << seed;
    EXPECT_LE(map.graph.edges.size(), num_edges + num_edges / 10) << seed;
  }
}

// The first session maps the southern corridor, the second goes on from there around the building and back.
TEST(GraphSessions, NewPlacesExtendTheMapAndCloseItsLoop) {
  const test::RoomWorld office = test::make_office();
  const Session first = map_session(office, {{8.0, 4.2}, {39.8, 4.2}}, 1);
  const SubmapGraph map = first.slam.submap_graph();
  const Session second =
      map_session(office, {{20.0, 4.2}, {39.8, 4.2}, {39.8, 25.8}, {4.2, 25.8}, {4.2, 4.2}, {20.0, 4.2}}, 2, &map);
  ASSERT_TRUE(second.slam.is_located());
  EXPECT_LT(max_error_m(second, first.drive[0].T_world_body), 0.15);
  const SubmapGraph extended = second.slam.submap_graph();
  EXPECT_GT(extended.keyframes.size(), 2 * map.keyframes.size());
  // Places that both sessions have seen are kept once.
  EXPECT_LT(extended.keyframes.size(), map.keyframes.size() + 9 * second.slam.node_scan_indices().size() / 10);
  const Session third = map_session(office, test::office_rounds(1), 3, &extended);
  ASSERT_TRUE(third.slam.is_located());
  EXPECT_LT(max_error_m(third, first.drive[0].T_world_body), 0.15);
}

TEST(GraphSessions, ASessionElsewhereIsAMapOfItsOwn) {
  const Session office = map_session(test::make_office(), test::office_rounds(1), 1);
  const SubmapGraph map = office.slam.submap_graph();
  test::RoomWorld hall;
  hall.add_box(0.0, 0.0, 25.0, 9.0).add_box(4.0, 3.0, 5.5, 4.0).add_box(15.0, 5.0, 15.7, 7.5).add_post(20.0, 3.0, 0.4);
  const std::vector<Eigen::Vector2d> corners = {{2.0, 2.0}, {23.0, 2.0}, {23.0, 7.0}, {2.0, 8.0}, {2.0, 2.0}};
  Session alone = map_session(hall, corners, 2), extending = map_session(hall, corners, 2, &map);
  EXPECT_FALSE(extending.slam.is_located());
  const std::vector<Pose2> path = alone.slam.path(), other = extending.slam.path();
  ASSERT_EQ(path.size(), other.size());
  for (std::size_t k = 0; k < path.size(); ++k) EXPECT_LT((path[k].position() - other[k].position()).norm(), 1e-6);
  EXPECT_EQ(extending.slam.submap_graph().keyframes.size(), alone.slam.submap_graph().keyframes.size());
  EXPECT_EQ(extending.slam.map().values(), alone.slam.map().values());
}

// Each place of the corridor looks like the others.
TEST(GraphSessions, AmongIdenticalDoorsWithoutAnEndASessionIsNotLocated) {
  const test::RoomWorld corridor = test::make_endless_corridor_of_doors(3.0, 0.0);
  const Session first = map_session(corridor, {{-20.0, 0.0}, {30.0, 0.0}}, 1);
  const SubmapGraph map = first.slam.submap_graph();
  const Session second = map_session(corridor, {{-5.0, 0.1}, {25.0, -0.1}}, 2, &map);
  EXPECT_FALSE(second.slam.is_located());
}

}  // namespace
}  // namespace patrol::slam::graph_sessions_test
