#include "stack/localization/delayed_localizer.h"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/state/message_state.h"
#include "localize/localize_state.h"
#include "stack/localization/make_localizer.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::delayed_localizer_test {
namespace {

using std::chrono::milliseconds;

constexpr Time kDelay = milliseconds(150);

LevelScan scan_at(Time stamp) {
  LevelScan scan;
  scan.stamp = stamp;
  return scan;
}

/// Localizer that records the order of what it is given.
class OrderRecorder final : public Localizer {
 public:
  OrderRecorder(bool is_mapping, std::string& order) : is_mapping_(is_mapping), order_(order) {}

  using Localizer::add;
  void add(const RangeWithOdometry&) override { order_ += 'r'; }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) override {
    order_ += 's';
    const PoseEstimate estimate{scan.stamp, T_odom_body};
    output.publish(estimate);
    return estimate;
  }
  OccupancyGrid map() override { return map_of_small_room(); }
  bool is_mapping() const override { return is_mapping_; }
  bool is_lost() const override { return false; }
  bool has_pose() const override { return true; }
  void serialize_state(StateArchive& archive) override { archive(order_); }

 private:
  bool is_mapping_;
  std::string& order_;
};

TEST(DelayedLocalizer, AScanOfAMapInProgressCorrectsThePoseAfterTheDelayAndNotBefore) {
  std::string order;
  DelayedLocalizer localizer(std::make_unique<OrderRecorder>(true, order), kDelay, false);
  localizer.begin_update(scan_at(milliseconds(100)), {1.0, 2.0, 0.5}, milliseconds(105));
  EXPECT_FALSE(localizer.take_due(milliseconds(254)));
  std::optional<PoseCorrection> correction = localizer.take_due(milliseconds(255));
  ASSERT_TRUE(correction);
  EXPECT_EQ(correction->stamp, milliseconds(100));
  EXPECT_EQ(correction->T_odom_body.vector(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(correction->estimate.T_map_body.vector(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(correction->output.take_messages().size(), 1U);
  EXPECT_FALSE(localizer.take_due(Time::max()));
}

TEST(DelayedLocalizer, OnAGivenMapAScanCorrectsThePoseAtOnce) {
  std::string order;
  DelayedLocalizer localizer(std::make_unique<OrderRecorder>(false, order), kDelay, true);
  localizer.begin_update(scan_at(milliseconds(100)), {}, milliseconds(105));
  EXPECT_TRUE(localizer.take_due(milliseconds(105)));
}

TEST(DelayedLocalizer, AThreadGetsScansAndRangesInTheirOrder) {
  for (const bool has_thread : {false, true}) {
    std::string order;
    DelayedLocalizer localizer(std::make_unique<OrderRecorder>(true, order), kDelay, has_thread);
    for (int i = 0; i < 20; ++i) {
      localizer.begin_update(scan_at(milliseconds(100 * i)), {}, milliseconds(100 * i));
      localizer.add(RangeWithOdometry{});
    }
    localizer.wait();
    EXPECT_EQ(order.size(), 40U);
    EXPECT_EQ(order.find("ss"), std::string::npos);
    EXPECT_EQ(order.find("rr"), std::string::npos);
  }
}

/// Returns the poses of scans in a room, and the state after scan 12; begins with `state` if it is not empty.
std::vector<Eigen::Vector3d> poses_in_room(bool has_thread, std::string& state) {
  const RobotDescription robot = test::make_quadruped();
  DelayedLocalizer localizer(make_localizer({}, robot, {}, {}, 1), kDelay, has_thread);
  const test::RoomWorld room = small_room();
  std::vector<Eigen::Vector3d> poses;
  int first = 0;
  if (!state.empty()) {
    StateArchive archive(state);
    archive(localizer);
    EXPECT_TRUE(archive.is_at_end());
    first = 13;
  }
  for (int i = first; i < 25; ++i) {
    const Time stamp = milliseconds(100 * i);
    while (auto correction = localizer.take_due(stamp)) poses.push_back(correction->estimate.T_map_body.vector());
    const Pose2 truth{0.05 * i, 0.0, 0.01 * i};
    LevelScan scan = room.scan(truth, {});
    scan.stamp = stamp;
    localizer.begin_update(scan, truth * Pose2{0.01, 0.0, 0.0}, stamp);
    if (i != 12 || !state.empty()) continue;
    StateArchive archive;
    archive(localizer);
    state = archive.bytes();
    poses.clear();
  }
  while (auto correction = localizer.take_due(Time::max())) poses.push_back(correction->estimate.T_map_body.vector());
  return poses;
}

TEST(DelayedLocalizer, AStateBetweenAScanAndItsCorrectionContinuesWithTheSamePosesInAThreadToo) {
  std::string state, state_of_thread;
  const std::vector<Eigen::Vector3d> whole = poses_in_room(false, state);
  EXPECT_EQ(whole.size(), 14U);  // two of the first 13 scans are still to take effect
  EXPECT_EQ(poses_in_room(true, state_of_thread), whole);
  EXPECT_EQ(state_of_thread, state);
  EXPECT_EQ(poses_in_room(true, state), whole);
}

}  // namespace
}  // namespace patrol::stack::delayed_localizer_test
