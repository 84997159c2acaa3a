#include "app/report/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_run.h"

namespace patrol::app::verdict_test {
namespace {

using report::Tone;
using test::small_run;
using ::testing::HasSubstr;

/// The cells of the row that begins with `name`; empty if there is none.
std::vector<std::string> row_of(const report::VerdictBlock& verdict, const std::string& name) {
  for (const std::vector<report::TableCell>& row : verdict.checks.rows) {
    std::vector<std::string> texts;
    for (const report::TableCell& cell : row) texts.push_back(cell.text);
    if (texts.front() == name) return texts;
  }
  return {};
}

using Texts = std::vector<std::string>;

TEST(Verdict, IsPassedWhenTheRunEndedAndMetEverything) {
  const report::VerdictBlock verdict = verdict_of(small_run());
  EXPECT_EQ(verdict.word, "Passed");
  EXPECT_EQ(verdict.tone, Tone::kGood);
  EXPECT_EQ(row_of(verdict, "pose.ate_rmse_m"), (Texts{"pose.ate_rmse_m", "<= 0.15", "0.1", "met"}));
}

TEST(Verdict, NamesWhatWasMissedWithWantedAndGot) {
  RunContents run = small_run();
  run.scenario.expect["pose.ate_rmse_m"].max = 0.05;
  run.scenario.expect["map.iou"].min = 0.5;
  const report::VerdictBlock verdict = verdict_of(run);
  EXPECT_EQ(verdict.word, "Missed");
  EXPECT_EQ(verdict.reason,
            "2 of 2 expectations missed: map.iou is not measured, expected >= 0.5; pose.ate_rmse_m is 0.1, expected <= "
            "0.05.");
  EXPECT_EQ(row_of(verdict, "pose.ate_rmse_m").back(), "MISSED");
}

TEST(Verdict, OfAFallOrATimeLimitIsMissedWhateverWasMet) {
  RunContents run = small_run();
  run.cases[0].result = io::JunitResult::kFailure;
  run.cases[0].message = "the robot fell at 9.50 s";
  EXPECT_EQ(verdict_of(run).word, "Missed");
  EXPECT_EQ(verdict_of(run).reason, "The run ended early: the robot fell at 9.50 s.");
}

TEST(Verdict, OfARunThatWasCutOffIsIncompleteAndJudgesNothing) {
  RunContents run = small_run();
  run.is_complete = false;
  run.metrics = io::Metrics::object();
  const report::VerdictBlock verdict = verdict_of(run);
  EXPECT_EQ(verdict.word, "INCOMPLETE");
  EXPECT_EQ(verdict.tone, Tone::kBad);
  EXPECT_THAT(verdict.reason, HasSubstr("10.0 s"));
  EXPECT_EQ(row_of(verdict, "pose.ate_rmse_m").back(), "unknown");
}

TEST(Verdict, SaysOfEachFaultWhatTheJunitSays) {
  RunContents run = small_run();
  run.scenario.faults = {{.sensor = "imu", .kind = "freeze", .start_s = 2.0},
                         {.sensor = "uwb", .kind = "dropout", .start_s = 3.0},
                         {.sensor = "gnss", .kind = "drift", .start_s = 4.0}};
  run.cases.push_back({.class_name = "small", .name = "fault imu freeze at 2 s", .message = "", .details = ""});
  run.cases.push_back({.class_name = "small",
                       .name = "fault uwb dropout at 3 s",
                       .result = io::JunitResult::kSkipped,
                       .message = "not triggered: no message was touched",
                       .details = ""});
  const report::VerdictBlock verdict = verdict_of(run);
  EXPECT_EQ(row_of(verdict, "fault imu freeze at 2 s").back(), "triggered");
  EXPECT_EQ(row_of(verdict, "fault uwb dropout at 3 s").back(), "not triggered");
  EXPECT_EQ(row_of(verdict, "fault gnss drift at 4 s").back(), "unknown");
  EXPECT_EQ(verdict.word, "Passed");
  EXPECT_THAT(verdict.reason, HasSubstr("One fault or kidnap was declared, but not triggered."));
}

TEST(Verdict, SaysOfEachKidnapWhatTheTruthInTheLogShows) {
  RunContents run = small_run();
  run.scenario.kidnaps = {{.at_s = 4.0, .x_m = 9.1, .y_m = 6.0},
                          {.at_s = 6.0, .x_m = 50.0, .y_m = 6.0},
                          {.at_s = 60.0, .x_m = 9.1, .y_m = 6.0}};
  const report::VerdictBlock verdict = verdict_of(run);
  EXPECT_EQ(row_of(verdict, "kidnap at 4 s").back(), "triggered");
  EXPECT_EQ(row_of(verdict, "kidnap at 6 s").back(), "not triggered");   // it is elsewhere
  EXPECT_EQ(row_of(verdict, "kidnap at 60 s").back(), "not triggered");  // the run was over
}

}  // namespace
}  // namespace patrol::app::verdict_test
