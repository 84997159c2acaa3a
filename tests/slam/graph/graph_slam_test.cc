#include "slam/graph/graph_slam.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam {
namespace {

struct MappedDrive {
  std::vector<test::DriveStep> drive;
  GraphSlam slam;
};

MappedDrive map_rounds(const test::RoomWorld& world, const std::vector<Eigen::Vector2d>& corners, const test::DriveOptions& options, const GraphSlamSettings& settings = {}) {
  MappedDrive mapped{.drive = test::drive_along(corners, options), .slam = GraphSlam(settings)};
  const RandomStream noise(1, "test/graph");
  for (std::size_t k = 0; k < mapped.drive.size(); ++k) {
    const test::DriveStep& step = mapped.drive[k];
    mapped.slam.update(world.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, k), step.T_odom_body);
  }
  mapped.slam.finish();
  return mapped;
}

double rms_error_m(const MappedDrive& mapped) {
  const std::vector<Pose2> path = mapped.slam.path();
  double sum = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) sum += (path[k].position() - (mapped.drive[0].T_world_body.inverse() * mapped.drive[k].T_world_body).position()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(path.size()));
}

// 125 m and a bit of corridor; odometry alone turns by a radian and ends tens of metres off.
TEST(GraphSlam, ARoundOfTheOfficeClosesToThreeCentimetres) {
  const MappedDrive mapped = map_rounds(test::make_office(), test::office_rounds(1), {});
  EXPECT_LT(rms_error_m(mapped), 0.03);
  EXPECT_GE(mapped.slam.loop_counts().closed, 1);
  EXPECT_EQ(mapped.slam.path().size(), mapped.drive.size());
}

TEST(GraphSlam, EveryLoopThatItClosesIsTrueToFiveCentimetres) {
  const MappedDrive mapped = map_rounds(test::make_office(), test::office_rounds(2), {});
  const std::vector<Pose2>& nodes = mapped.slam.graph().T_map_node;
  int loops = 0;
  for (const PoseGraphEdge& edge : mapped.slam.graph().edges) {
    if (edge.kind != PoseGraphEdge::Kind::kLoop) continue;
    ++loops;
    EXPECT_LT(edge_error(edge, nodes).head<2>().norm(), 0.05);
  }
  EXPECT_GT(loops, 100);
  EXPECT_LT(rms_error_m(mapped), 0.03);
}

// Up and down among doors that are all alike, odometry 8 % too long: 4 m of doubt at the end, more than from door to door.
TEST(GraphSlam, AmongIdenticalDoorsNoFalseLoopIsClosed) {
  const MappedDrive mapped = map_rounds(test::make_corridor_of_doors(), {{20.0, 0.0}, {45.0, 0.0}, {15.0, 0.0}, {45.0, 0.0}, {20.0, 0.0}}, {.odometry_scale = 0.01});
  const std::vector<test::DriveStep>& drive = mapped.drive;
  const std::vector<Pose2> path = mapped.slam.path();
  double worst = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) worst = std::max(worst, (path[k].position() - (drive[0].T_world_body.inverse() * drive[k].T_world_body).position()).norm());
  EXPECT_LT(worst, 0.5);  // a door off would be 3 m
}

TEST(GraphSlam, TheSameScansGiveTheSamePathToTheBit) {
  const std::vector<Eigen::Vector2d> corners = {{8.0, 4.2}, {16.0, 4.2}, {8.0, 4.2}};
  const std::vector<Pose2> first = map_rounds(test::make_office(), corners, {}).slam.path(), second = map_rounds(test::make_office(), corners, {}).slam.path();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(first[k].vector(), second[k].vector()) << k;
}

TEST(GraphSlam, BeforeAnyScanItHasNoPathAndAfterOneItStandsAtTheOrigin) {
  GraphSlam slam({});
  EXPECT_TRUE(slam.path().empty());
  slam.finish();
  const Pose2 pose = slam.update(test::make_office().scan({8.0, 4.2, 0.0}, test::kOldLidar), {5.0, 5.0, 1.0});
  EXPECT_THAT(pose, test::Pose2Near(Pose2{}, 1e-12, 1e-12));
  EXPECT_EQ(slam.path().size(), 1U);
}

}  // namespace
}  // namespace patrol::slam
