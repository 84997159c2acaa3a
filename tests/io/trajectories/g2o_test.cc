#include "io/trajectories/g2o.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::g2o_test {
namespace {

using test::Pose2Near, test::TemporaryFile, test::TemporaryFolder;

constexpr const char* kTwoNodes = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";

PoseGraph read(const std::string& text) { return load_g2o(TemporaryFile("a.g2o", text).path()); }

std::string complaint_about(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("a.g2o"));
  }
  return "";
}

TEST(LoadG2o, ReadsVerticesAndEdgesWithTheWholeInformation) {
  const PoseGraph graph =
      read("# a graph\nVERTEX_SE2 0 0 0 0\n\nVERTEX_SE2 1 1.5 -2 0.25\r\nEDGE_SE2 0 1 1.4 -2.1 0.3 10 1 2 20 3 30\n");
  ASSERT_EQ(graph.T_map_node.size(), 2U);
  EXPECT_THAT(graph.T_map_node[1], Pose2Near(Pose2{1.5, -2.0, 0.25}, 0.0, 0.0));
  ASSERT_EQ(graph.edges.size(), 1U);
  EXPECT_THAT(graph.edges[0].T_from_to, Pose2Near(Pose2{1.4, -2.1, 0.3}, 0.0, 0.0));
  Eigen::Matrix3d information;
  information << 10.0, 1.0, 2.0, 1.0, 20.0, 3.0, 2.0, 3.0, 30.0;
  EXPECT_EQ(graph.edges[0].information, information);
}

TEST(LoadG2o, IdsNeedNotBeInOrderNorBeforeTheirEdges) {
  const PoseGraph graph = read("EDGE_SE2 900 7 1 0 0 1 0 0 1 0 1\nVERTEX_SE2 7 1 0 0\nVERTEX_SE2 900 2 0 0\nFIX 900\n");
  EXPECT_EQ(graph.T_map_node[0].x, 1.0);
  EXPECT_EQ(graph.edges[0].from, 1);
  EXPECT_EQ(graph.edges[0].to, 0);
}

TEST(LoadG2o, AnEdgeToTheNextNodeIsOdometryEveryOtherALoop) {
  const std::string three_nodes = std::string(kTwoNodes) + "VERTEX_SE2 2 2 0 0\n";
  const PoseGraph graph = read(
      three_nodes + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 0 1 0 0 1 0 0 1 0 1\n");
  EXPECT_EQ(graph.edges[0].kind, PoseGraphEdge::Kind::kOdometry);
  EXPECT_EQ(graph.edges[1].kind, PoseGraphEdge::Kind::kLoop);
  EXPECT_EQ(graph.edges[2].kind, PoseGraphEdge::Kind::kLoop);
}

TEST(LoadG2o, WhatCannotBeReadIsNamedByItsLine) {
  const auto complaint = [](const std::string& line) { return complaint_about(kTwoNodes + line); };
  EXPECT_EQ(complaint("VERTEX_SE2 2 1 0\n"), "a.g2o:3: VERTEX_SE2: ends before pose");
  EXPECT_EQ(complaint("VERTEX_SE2 2 1 0 nan\n"), "a.g2o:3: VERTEX_SE2: pose 'nan' is not a finite number");
  EXPECT_EQ(complaint("VERTEX_SE2 2 1 0 0 5\n"), "a.g2o:3: VERTEX_SE2: too many words");
  EXPECT_EQ(complaint("VERTEX_SE2 -2 1 0 0\n"),
            "a.g2o:3: VERTEX_SE2: id '-2' must be an integer in [0, 9223372036854775807]");
  EXPECT_EQ(complaint("VERTEX_SE2 1 1 0 0\n"), "a.g2o:3: VERTEX_SE2: id 1: duplicate");
  EXPECT_EQ(complaint("EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n"), "a.g2o:3: EDGE_SE2: ends before information");
  EXPECT_EQ(complaint("EDGE_SE2 0 1 1 0 0 1 0 0 -1 0 1\n"), "a.g2o:3: EDGE_SE2: information is not positive definite");
  EXPECT_EQ(complaint("EDGE_SE2 0 1 1 0 0 0 0 0 0 0 0\n"), "a.g2o:3: EDGE_SE2: information is not positive definite");
  EXPECT_EQ(complaint("EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"), "a.g2o:3: EDGE_SE2: goes from 1 to itself");
  EXPECT_EQ(complaint("\nEDGE_SE2 0 5 1 0 0 1 0 0 1 0 1\n"), "a.g2o:4: unknown VERTEX_SE2 5");
  EXPECT_EQ(complaint("FIX 5\n"), "a.g2o:3: unknown VERTEX_SE2 5");
  EXPECT_EQ(complaint("FIX\n"), "a.g2o:3: FIX: ends before id");
  EXPECT_EQ(complaint("VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"),
            "a.g2o:3: VERTEX_SE3:QUAT: unknown tag (known: VERTEX_SE2, EDGE_SE2, FIX)");
  EXPECT_EQ(complaint(std::string(2'000'000, 'x')), "a.g2o:3: is too long");
}

TEST(LoadG2o, AnEmptyOrMissingFileIsRefused) {
  EXPECT_EQ(complaint_about("# none\n"), "a.g2o: contains no VERTEX_SE2");
  EXPECT_THROW(load_g2o("/nowhere/a.g2o"), InputError);
}

TEST(ToG2o, WritesIdsByPlaceAndFixesTheFirst) {
  PoseGraph graph{.T_map_node = {{}, {1.0, 0.5, -0.25}},
                  .edges = {{.from = 0, .to = 1, .T_from_to = {1.0, 0.5, -0.25}}}};
  graph.edges[0].information(0, 1) = graph.edges[0].information(1, 0) = 0.5;
  EXPECT_EQ(to_g2o(graph),
            "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0.5 -0.25\nFIX 0\nEDGE_SE2 0 1 1 0.5 -0.25 1 0.5 0 1 0 1\n");
}

TEST(SaveG2o, ThereAndBackIsTheSameToTheBit) {
  const TemporaryFolder folder;
  PoseGraph was;
  for (int i = 0; i < 5; ++i) was.T_map_node.push_back({i / 3.0, -i / 7.0, i / 11.0});
  for (int i = 1; i < 5; ++i) {
    PoseGraphEdge edge{.from = i - 1, .to = i, .T_from_to = {1.0 / i, 2.0 / 3.0, 1e-17 * i}};
    edge.information = Eigen::Matrix3d::Identity() * (100.0 / 3.0) * i;
    was.edges.push_back(edge);
  }
  was.edges.push_back({.from = 4, .to = 0, .T_from_to = {0.1, 0.2, 0.3}, .kind = PoseGraphEdge::Kind::kLoop});
  save_g2o(folder / "a.g2o", was);
  const PoseGraph is = load_g2o(folder / "a.g2o");
  ASSERT_EQ(is.T_map_node.size(), 5U);
  ASSERT_EQ(is.edges.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(is.T_map_node[i].vector(), was.T_map_node[i].vector());
    EXPECT_EQ(is.edges[i].T_from_to.vector(), was.edges[i].T_from_to.vector());
    EXPECT_EQ(is.edges[i].information, was.edges[i].information);
    EXPECT_EQ(is.edges[i].kind, was.edges[i].kind);
  }
}

}  // namespace
}  // namespace patrol::io::g2o_test
