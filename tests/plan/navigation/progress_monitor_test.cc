#include "plan/navigation/progress_monitor.h"

#include <gtest/gtest.h>

namespace patrol::plan::progress_monitor_test {
namespace {

using namespace std::chrono_literals;

TEST(ProgressMonitor, IsStuckAfterItsTimeAtAboutTheSamePlace) {
  ProgressMonitor monitor(15.0);
  EXPECT_FALSE(monitor.is_stuck(0s, {0.0, 0.0, 0.0}));
  EXPECT_FALSE(monitor.is_stuck(15s, {0.4, 0.0, 0.0}));
  EXPECT_TRUE(monitor.is_stuck(16s, {0.0, 0.4, 0.0}));
  EXPECT_FALSE(monitor.is_stuck(17s, {0.6, 0.0, 0.0})) << "it has moved away";
  EXPECT_TRUE(monitor.is_stuck(33s, {0.6, 0.0, 0.0}));
}

TEST(ProgressMonitor, WaitingForARouteRestartsTheTimeButKeepsThePlace) {
  ProgressMonitor monitor(15.0);
  EXPECT_FALSE(monitor.is_stuck(0s, {}));
  monitor.restart_time(14s);
  EXPECT_FALSE(monitor.is_stuck(20s, {}));
  EXPECT_TRUE(monitor.is_stuck(30s, {}));
  monitor.restart();
  EXPECT_FALSE(monitor.is_stuck(31s, {}));
}

TEST(ProgressMonitor, HalfAMeterNearerIsProgress) {
  ProgressMonitor monitor(15.0);
  EXPECT_TRUE(monitor.has_progressed(8.0));
  EXPECT_FALSE(monitor.has_progressed(7.6));
  EXPECT_FALSE(monitor.has_progressed(9.0));
  EXPECT_TRUE(monitor.has_progressed(7.4));
  monitor.reset();
  EXPECT_TRUE(monitor.has_progressed(20.0));
}

}  // namespace
}  // namespace patrol::plan::progress_monitor_test
