#include "app/run/event_subjects.h"

#include <gtest/gtest.h>

namespace patrol::app::event_subjects_test {
namespace {

Event event_of(EventKind kind, const std::string& subject) { return {.kind = kind, .subject = subject}; }

TEST(EventSubjects, WarnsOnceOfAnUnknownStationAndOfAnUnknownGoalWithTheKnownOnes) {
  EventSubjects subjects({"box", "well"}, {"goal_1"});
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kStationReached, "well")), "");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kStationReached, "well_zero")),
            "station_reached with subject well_zero is not scored: stations of the run: box, well");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kStationReached, "well_one")), "");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalReached, "goal_1")), "");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalFailed, "a\nb")),
            "goal_failed with subject a\\nb is not scored: goals of the run: goal_1");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalReached, "goal_7")), "");
}

TEST(EventSubjects, KnowsGoalsThatTheRobotSaves) {
  EventSubjects subjects({}, {});
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalSaved, "goal_1")), "");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalReached, "goal_1")), "");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kGoalReached, "")),
            "goal_reached with subject \"\" is not scored: goals of the run: goal_1");
  EXPECT_EQ(subjects.warning_of(event_of(EventKind::kStationReached, "box")),
            "station_reached with subject box is not scored: stations of the run: none");
}

TEST(EventSubjects, IgnoresOtherKinds) {
  EventSubjects subjects({}, {});
  for (const EventKind kind : {EventKind::kForeign, EventKind::kGasAlarm, EventKind::kDocked, EventKind::kSensorFault})
    EXPECT_EQ(subjects.warning_of(event_of(kind, "thing")), "");
}

}  // namespace
}  // namespace patrol::app::event_subjects_test
