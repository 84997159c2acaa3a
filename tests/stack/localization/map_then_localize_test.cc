#include "stack/localization/map_then_localize.h"

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

/// Localizer that records the ranges it is given. If it maps, it has measured ranges of anchor 3, which is 5 m ahead of
/// the origin: 0.2 m too long at the origin, and 0.1 m too long 30 m to the left.
class RangeRecorder final : public Localizer {
 public:
  RangeRecorder(bool is_mapping, std::vector<double>& ranges_m) : is_mapping_(is_mapping), ranges_m_(ranges_m) {}

  using Localizer::add;
  void add(const RangeWithOdometry& range) override { ranges_m_.push_back(range.range.range_m); }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput&) override {
    return {scan.stamp, T_odom_body};
  }
  OccupancyGrid map() override { return map_of_small_room(); }
  std::vector<slam::MappedRange> mapped_ranges() const override {
    const auto too_long = [](const Pose2& T_map_body, double error_m) {
      return slam::MappedRange{.anchor = 3,
                               .T_map_body = T_map_body,
                               .range_m = predict_uwb_range(kAnchor, T_map_body, {0.0, 0.0, 0.0}, {}).range_m + error_m,
                               .count = 1000};
    };
    return {too_long({}, 0.2), too_long({0.0, 30.0, 0.0}, 0.1)};
  }
  bool is_mapping() const override { return is_mapping_; }
  bool is_lost() const override { return false; }
  bool has_pose() const override { return true; }
  void serialize_state(StateArchive&) override {}

  static inline const UwbAnchor kAnchor{.number = 3, .p_m = {5.0, 0.0, 0.0}};

 private:
  bool is_mapping_;
  std::vector<double>& ranges_m_;
};

TEST(MapThenLocalize, RangesOnTheCompleteMapLackTheErrorThatTheMappingMeasuredNearby) {
  std::vector<double> mapped_m, localized_m;
  MapThenLocalize localizer(std::make_unique<RangeRecorder>(true, mapped_m), {RangeRecorder::kAnchor},
                            [&](const OccupancyGrid&) { return std::make_unique<RangeRecorder>(false, localized_m); });
  const RangeWithOdometry known{.range = {.anchor = 3, .range_m = 5.0}, .T_odom_body = {}},
      unknown{.range = {.anchor = 4, .range_m = 5.0}, .T_odom_body = {}};
  StackOutput output;
  localizer.add(known);
  localizer.finish_map({});
  localizer.add(known);  // before the first pose: the mean error
  for (const double y : {0.0, 30.0}) {
    localizer.update({}, {0.0, y, 0.0}, output);
    localizer.add(known);
  }
  localizer.add(unknown);
  EXPECT_EQ(mapped_m, std::vector<double>({5.0}));
  ASSERT_EQ(localized_m.size(), 4U);
  EXPECT_NEAR(localized_m[0], 4.85, 1e-9);
  EXPECT_NEAR(localized_m[1], 4.8, 0.002);
  EXPECT_NEAR(localized_m[2], 4.9, 0.002);
  EXPECT_EQ(localized_m[3], 5.0);
}

}  // namespace
}  // namespace patrol::stack::map_then_localize_test
