#include "stack/localization/map_then_localize.h"

#include <gtest/gtest.h>

#include "stack/localization/make_localizer.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::map_then_localize_test {
namespace {

TEST(MapThenLocalize, LocalizesOnItsOwnMapFromWhereTheMappingEnded) {
  const RobotDescription robot = test::make_quadruped();
  const auto localizer = make_localizer({}, robot, {}, {.has_mapping_drive = true}, 1);
  const test::RoomWorld room = small_room();
  StackOutput output;
  PoseEstimate pose;
  const auto drive = [&](int from, int to) {
    for (int i = from; i <= to; ++i) {
      const Pose2 truth{0.05 * i, 0.0, 0.0};
      LevelScan scan = room.scan(truth, {});
      scan.stamp = from_seconds(0.1 * i);
      pose = localizer->update(scan, truth, output);
      EXPECT_LT((pose.T_map_body.position() - truth.position()).norm(), 0.03) << i;
    }
  };
  drive(0, 20);
  EXPECT_TRUE(localizer->is_mapping());
  EXPECT_TRUE(localizer->has_pose());
  localizer->finish_map(pose);
  EXPECT_FALSE(localizer->is_mapping());
  EXPECT_FALSE(localizer->has_pose());  // before the first scan on the finished map
  const OccupancyGrid map = localizer->map();
  drive(21, 30);
  EXPECT_TRUE(localizer->has_pose());
  EXPECT_FALSE(localizer->is_lost());
  EXPECT_EQ(localizer->map().values(), map.values());
}

}  // namespace
}  // namespace patrol::stack::map_then_localize_test
