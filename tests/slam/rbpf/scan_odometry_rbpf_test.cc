#include "slam/rbpf/scan_odometry_rbpf.h"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/methods/mapper.h"
#include "tests/slam/graph/office_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::scan_odometry_rbpf_test {
namespace {

const std::vector<test::DriveStep>& short_drive() {
  static const std::vector<test::DriveStep> drive = test::drive_along({{8.0, 4.2}, {14.0, 4.2}, {10.0, 4.3}}, {});
  return drive;
}

template <typename Mapping>
void map_drive(Mapping& mapping) {
  const RandomStream noise(1, "test/rbpf");
  const test::RoomWorld office = test::make_office();
  for (std::size_t k = 0; k < short_drive().size(); ++k) {
    mapping.update(office.scan(short_drive()[k].T_world_body, short_drive()[k].stamp, test::kOldLidar, noise, k),
                   short_drive()[k].T_odom_body);
  }
  mapping.finish();
}

double worst_error_m(const std::vector<Pose2>& path) {
  double worst = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    worst = std::max(worst, (path[k].position() -
                             (short_drive()[0].T_world_body.inverse() * short_drive()[k].T_world_body).position())
                                .norm());
  }
  return worst;
}

TEST(ScanOdometryRbpf, FollowsTenMetersToThreeCentimetersAndKeepsAPoseForEveryScan) {
  ScanOdometryRbpf rbpf({}, 1);
  map_drive(rbpf);
  EXPECT_EQ(rbpf.path().size(), short_drive().size());
  EXPECT_LT(worst_error_m(rbpf.path()), 0.03);
  EXPECT_EQ(rbpf.graph().edges.size() + 1, rbpf.graph().T_map_node.size());
}

// With `odometry: given` the filter sees the odometry itself: no matching from scan to scan comes before.
TEST(ScanOdometryRbpf, WithGivenOdometryIsTheFilterAlone) {
  ScanOdometryRbpfSettings settings{.odometry = "given", .scan_odometry = {}};
  ScanOdometryRbpf rbpf(settings, 1);
  TrajectoryRbpf filter(settings.filter, 1);
  map_drive(rbpf);
  map_drive(filter);
  ASSERT_EQ(rbpf.path().size(), filter.path().size());
  EXPECT_EQ(rbpf.path().back().vector(), filter.path().back().vector());
  settings.odometry = "wheels";
  EXPECT_THROW(ScanOdometryRbpf(settings, 1), InputError);
}

TEST(MakeMapper, EveryMethodFollowsTenMetersToFourCentimeters) {
  for (const std::string& method : names_of(mapping_methods())) {
    MapperSettings settings;
    settings.method = method;
    const std::unique_ptr<Mapper> mapper = make_mapper(settings, {}, 1);
    map_drive(*mapper);
    EXPECT_LT(worst_error_m(mapper->path()), 0.04) << method;
    EXPECT_GT(mapper->map().geometry().size(), 10'000U) << method;
    EXPECT_FALSE(mapper->graph().T_map_node.empty()) << method;
  }
}

TEST(MakeMapper, AMethodThatIsNotThereIsRefused) {
  MapperSettings settings;
  settings.method = "magic";
  EXPECT_THROW(make_mapper(settings, {}, 1), InputError);
}

// As from an old parent: released in a loop, not by a hundred thousand calls within each other.
TEST(TrajectoryNode, ATrajectoryOfAMillionNodesIsReleased) {
  std::shared_ptr<TrajectoryNode> path;
  for (int i = 0; i < 1'000'000; ++i) path = std::make_shared<TrajectoryNode>(Pose2{}, path);
  const std::shared_ptr<TrajectoryNode> shared = path->before->before;
  path.reset();
  EXPECT_EQ(shared.use_count(), 1);
}

}  // namespace
}  // namespace patrol::slam::scan_odometry_rbpf_test
