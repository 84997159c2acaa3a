#include "app/run/run_verdict.h"

#include <gtest/gtest.h>

namespace patrol::app::run_verdict_test {
namespace {

CheckedExpectation make_check(bool is_met) {
  return {.metric = "pose.ate_rmse_m",
          .wanted = "<= 0.08",
          .got = is_met ? "0.05" : "0.21",
          .is_measured = true,
          .is_met = is_met};
}

RunOutcome ended(RunEnd end, double duration_s) {
  RunOutcome outcome;
  outcome.end = end;
  outcome.duration = from_seconds(duration_s);
  return outcome;
}

TEST(RunVerdict, DoneWhenTheMissionIsOverAndEverythingIsMet) {
  const RunVerdict verdict = verdict_of(ended(RunEnd::kMissionOver, 60.0), {}, {}, {make_check(true)});
  EXPECT_EQ(verdict.end, RunStatus::kDone);
  EXPECT_EQ(verdict.code(), ExitCode::kDone);
  EXPECT_EQ(verdict.message, "");
}

TEST(RunVerdict, AMissedExpectationIsSaidWithWhatItGot) {
  const RunVerdict verdict =
      verdict_of(ended(RunEnd::kMissionOver, 60.0), {}, {}, {make_check(true), make_check(false), make_check(false)});
  EXPECT_EQ(verdict.end, RunStatus::kExpectationMissed);
  EXPECT_EQ(verdict.code(), ExitCode::kExpectationMissed);
  EXPECT_EQ(verdict.message, "pose.ate_rmse_m is 0.21, expected <= 0.08; pose.ate_rmse_m is 0.21, expected <= 0.08");
}

TEST(RunVerdict, AFallAndATimeLimitComeBeforeWhatTheyMadeItMiss) {
  EXPECT_EQ(verdict_of(ended(RunEnd::kFall, 33.0), {}, {}, {make_check(false)}).end, RunStatus::kFall);
  EXPECT_EQ(verdict_of(ended(RunEnd::kTimeLimit, 33.0), {}, {}, {make_check(false)}).code(), ExitCode::kTimeLimit);
}

TEST(RunVerdict, ATimeLimitIsWrittenWithItsFraction) {
  EXPECT_EQ(verdict_of(ended(RunEnd::kTimeLimit, 0.3), {}, {}, {}).message, "0.3 s");
  EXPECT_EQ(verdict_of(ended(RunEnd::kTimeLimit, 600.0), {}, {}, {}).message, "600 s");
}

TEST(RunVerdict, KidnapsThatTheRunDidNotReachAreNotExecuted) {
  RunOutcome outcome = ended(RunEnd::kMissionOver, 60.0);
  outcome.num_kidnaps = 1;
  const RunVerdict verdict = verdict_of(outcome, {{.at_s = 10.0}, {.at_s = 900.0}}, {}, {});
  ASSERT_EQ(verdict.events.size(), 2u);
  EXPECT_TRUE(verdict.events[0].was_triggered);
  EXPECT_FALSE(verdict.events[1].was_triggered);
  EXPECT_EQ(verdict.events[1].name, "kidnap at 900 s");
}

TEST(RunVerdict, KidnapsAreExecutedInTheOrderOfTheirTimes) {
  RunOutcome outcome = ended(RunEnd::kMissionOver, 60.0);
  outcome.num_kidnaps = 2;
  const RunVerdict verdict = verdict_of(outcome, {{.at_s = 900.0}, {.at_s = 10.0}, {.at_s = 10.0}}, {}, {});
  ASSERT_EQ(verdict.events.size(), 3u);
  EXPECT_FALSE(verdict.events[0].was_triggered);
  EXPECT_TRUE(verdict.events[1].was_triggered);
  EXPECT_TRUE(verdict.events[2].was_triggered);
}

TEST(RunVerdict, ComesBackFromJson) {
  RunOutcome outcome = ended(RunEnd::kTimeLimit, 60.0);
  outcome.faults = {{.fault = {.sensor = "imu", .kind = "freeze", .start_s = 12.0}, .was_triggered = true}};
  const RunVerdict verdict = verdict_of(outcome, {}, {{"pose", {{"ate_rmse_m", 0.25}}}}, {make_check(false)});
  EXPECT_EQ(to_json(verdict_from_json(to_json(verdict))), to_json(verdict));
}

}  // namespace
}  // namespace patrol::app::run_verdict_test
