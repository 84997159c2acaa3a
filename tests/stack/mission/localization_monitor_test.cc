#include "stack/mission/localization_monitor.h"

#include <gtest/gtest.h>

namespace patrol::stack::localization_monitor_test {
namespace {

using Status = LocalizationMonitor::Status;

TEST(LocalizationMonitor, ReportsTheLossOnceAndItsDuration) {
  LocalizationMonitor monitor(30.0);
  std::vector<Event> events;
  EXPECT_EQ(monitor.step(from_seconds(1.0), false, {}, events), Status::kUsable);
  EXPECT_TRUE(events.empty());
  EXPECT_EQ(monitor.step(from_seconds(2.0), true, {1.0, 2.0, 0.0}, events), Status::kRelocalizing);
  EXPECT_EQ(monitor.step(from_seconds(3.0), true, {}, events), Status::kRelocalizing);
  EXPECT_EQ(monitor.step(from_seconds(4.5), false, {}, events), Status::kUsable);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, EventKind::kLocalizationLost);
  EXPECT_EQ(events[0].stamp, from_seconds(2.0));
  EXPECT_EQ(events[0].p_map_target, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(events[1].kind, EventKind::kRelocalized);
  EXPECT_EQ(events[1].value, 2.5);
}

TEST(LocalizationMonitor, FailsAfterTheTimeout) {
  LocalizationMonitor monitor(30.0);
  std::vector<Event> events;
  monitor.step(from_seconds(2.0), true, {}, events);
  EXPECT_EQ(monitor.step(from_seconds(32.0), true, {}, events), Status::kRelocalizing);
  EXPECT_EQ(monitor.step(from_seconds(32.1), true, {}, events), Status::kFailed);
  EXPECT_EQ(events.back().text, "Relocalization failed after 30 s.");
}

}  // namespace
}  // namespace patrol::stack::localization_monitor_test
