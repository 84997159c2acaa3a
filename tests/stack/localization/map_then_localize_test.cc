#include "stack/localization/map_then_localize.h"

#include <map>
#include <memory>
#include <vector>

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

/// Localizer that records the ranges it is given, and has delays of anchors if it maps.
class RangeRecorder final : public Localizer {
 public:
  RangeRecorder(bool is_mapping, std::vector<double>& ranges_m) : is_mapping_(is_mapping), ranges_m_(ranges_m) {}

  using Localizer::add;
  void add(const RangeWithOdometry& range) override { ranges_m_.push_back(range.range.range_m); }
  PoseEstimate update(const LevelScan& scan, const Pose2&, StackOutput&) override { return {.stamp = scan.stamp}; }
  OccupancyGrid map() override { return map_of_small_room(); }
  std::map<int, double> range_delays_m() const override { return {{3, 0.2}}; }
  bool is_mapping() const override { return is_mapping_; }
  bool is_lost() const override { return false; }
  bool has_pose() const override { return true; }

 private:
  bool is_mapping_;
  std::vector<double>& ranges_m_;
};

TEST(MapThenLocalize, RangesOnTheCompleteMapLackTheDelayThatTheMappingEstimated) {
  std::vector<double> mapped_m, localized_m;
  MapThenLocalize localizer(std::make_unique<RangeRecorder>(true, mapped_m),
                            [&](const OccupancyGrid&) { return std::make_unique<RangeRecorder>(false, localized_m); });
  const RangeWithOdometry delayed{.range = {.anchor = 3, .range_m = 5.0}},
      unknown{.range = {.anchor = 4, .range_m = 5.0}};
  localizer.add(delayed);
  localizer.finish_map({});
  localizer.add(delayed);
  localizer.add(unknown);
  EXPECT_EQ(mapped_m, std::vector<double>({5.0}));
  EXPECT_EQ(localized_m, std::vector<double>({4.8, 5.0}));
}

}  // namespace
}  // namespace patrol::stack::map_then_localize_test
