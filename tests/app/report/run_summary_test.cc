#include "app/report/run_summary.h"

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::run_summary_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CheckedExpectation check(const std::string& metric, bool is_met) {
  return {.metric = metric, .wanted = "<= 0.08", .got = "0.05", .is_measured = true, .is_met = is_met};
}

/// Metrics with more key figures than a summary shows.
io::Metrics rich_metrics() {
  return io::Metrics::parse(R"({
    "mission": {"completed": true, "collisions": 0, "distance_m": 194.2, "duration_s": 300.5},
    "pose": {"ate_rmse_m": 0.0712, "ate_max_m": 0.2, "heading_rmse_deg": 0.31},
    "odometry": {"ate_rmse_m": 1.2},
    "map": {"nearest_mean_m": 0.029, "coverage": 0.87},
    "stations": [{"name": "box", "reached": true}, {"name": "well", "reached": false}],
    "goals": [{"name": "goal_1", "arrivals": 2, "failed": 0, "position_error_m": {"mean": 0.02, "std": 0.01},
               "heading_error_deg": {"mean": 0.3, "std": 0.1}}],
    "docking": {"arrivals": 2, "failed": 0, "position_error_m": {"max": 0.01}},
    "inspection": {"leaks": 2, "leaks_found": 1, "false_alarms": 0,
                   "lining": {"moved_rings": 3, "found": 2, "false_findings": 1},
                   "water": {"bodies": 1, "found": 1, "false_alarms": 0}},
    "performance": {"real_time_factor": 9.5}
  })");
}

RunVerdict verdict_with(std::vector<CheckedExpectation> checks) {
  RunVerdict verdict{.end = status_of(RunEnd::kMissionOver, checks),
                     .message = "",
                     .metrics = rich_metrics(),
                     .checks = std::move(checks),
                     .events = {}};
  return verdict;
}

std::ptrdiff_t num_lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(RunSummary, HasAtMost25Lines) {
  std::vector<CheckedExpectation> checks;
  for (int i = 0; i < 40; ++i) checks.push_back(check(fmt::format("metric_{}", i), i % 3 == 0));
  RunVerdict verdict = verdict_with(checks);
  verdict.events = {{.name = "fault imu freeze at 12 s", .was_triggered = false},
                    {.name = "kidnap at 40 s", .was_triggered = false}};
  const std::string text = run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain);
  EXPECT_LE(num_lines(text), static_cast<std::ptrdiff_t>(kMaxSummaryLines));
  EXPECT_GE(num_lines(text), 20);
}

TEST(RunSummary, NamesTheFirstStationsThatWereNotReached) {
  RunVerdict verdict = verdict_with({});
  const auto summary = [&verdict] { return run_summary("site/patrol, seed 1", verdict, "out/run", TextStyle::kPlain); };
  EXPECT_THAT(summary(), HasSubstr("1 of 2  not: well\n"));
  verdict.metrics["stations"] = io::Metrics::array();
  for (const char* name : {"a", "b", "c", "d", "e"})
    verdict.metrics["stations"].push_back({{"name", name}, {"reached", false}});
  EXPECT_THAT(summary(), HasSubstr("0 of 5  not: a, b, c and 2 more\n"));
  verdict.metrics["stations"][0]["reached"] = nullptr;
  EXPECT_THAT(summary(), HasSubstr("0 of 5  not: b, c, d and 1 more\n"));
}

TEST(RunSummary, HasNoRowsOfWhatWasNotMeasured) {
  RunVerdict verdict = verdict_with({});
  for (io::Metrics& station : verdict.metrics["stations"]) station["reached"] = nullptr;
  verdict.metrics["goals"][0]["arrivals"] = verdict.metrics["goals"][0]["failed"] = nullptr;
  verdict.metrics["docking"]["arrivals"] = verdict.metrics["docking"]["failed"] = nullptr;
  verdict.metrics["inspection"]["leaks_found"] = verdict.metrics["inspection"]["false_alarms"] = nullptr;
  const std::string text = run_summary("site/patrol, seed 1", verdict, "out/run", TextStyle::kPlain);
  for (const char* row : {"Stations", "Goals", "Dockings", "Leaks"}) EXPECT_THAT(text, Not(HasSubstr(row)));
  EXPECT_THAT(text, HasSubstr("Moved rings found"));
}

TEST(RunSummary, BeginsWithTheStatusAndTheNumberOfExpectations) {
  const RunVerdict verdict = verdict_with({check("pose.ate_rmse_m", true), check("map.coverage", true)});
  EXPECT_THAT(run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain),
              ::testing::StartsWith("street/patrol, seed 1: done, 2 of 2 expectations met\n"));
}

TEST(RunSummary, ShowsMissedExpectationsFirst) {
  std::vector<CheckedExpectation> checks;
  for (int i = 0; i < 20; ++i) checks.push_back(check(fmt::format("metric_{}", i), i != 19));
  const std::string text = run_summary("street/patrol, seed 1", verdict_with(checks), "out/run", TextStyle::kPlain);
  EXPECT_LT(text.find("metric_19"), text.find("metric_0 "));
  EXPECT_THAT(text, HasSubstr("12 further expectations: met"));
}

TEST(RunSummary, NamesAFallAndEventsThatWereNotTriggered) {
  RunVerdict verdict = verdict_with({});
  verdict.end = RunStatus::kFall;
  verdict.message = "the robot fell at 3.20 s";
  verdict.events = {{.name = "kidnap at 40 s", .was_triggered = false},
                    {.name = "kidnap at 2 s", .was_triggered = true}};
  const std::string text = run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain);
  EXPECT_THAT(text, HasSubstr("fall (the robot fell at 3.20 s), no expectations"));
  EXPECT_THAT(text, HasSubstr("not triggered: kidnap at 40 s\n"));
}

TEST(RunSummary, BeginsTheKeyMetricsWithReportsThatTheTruthContradicts) {
  RunVerdict verdict = verdict_with({});
  EXPECT_THAT(run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain), Not(HasSubstr("FALSE")));
  verdict.metrics["mission"]["completed"] = false;
  verdict.metrics["mission"]["reported_completed"] = true;
  verdict.metrics["mission"]["false_arrivals"] = 4;
  const std::string text = run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain);
  EXPECT_THAT(text, HasSubstr("NOT COMPLETED  the true path contradicts the report of the robot"));
  EXPECT_LT(text.find("FALSE ARRIVALS"), text.find("Position error"));
}

TEST(RunSummary, HasColorsOnlyInColorStyle) {
  const RunVerdict verdict = verdict_with({check("pose.ate_rmse_m", true), check("map.coverage", false)});
  EXPECT_THAT(run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kPlain), Not(HasSubstr("\033")));
  const std::string colored = run_summary("street/patrol, seed 1", verdict, "out/run", TextStyle::kColor);
  EXPECT_THAT(colored, HasSubstr("\033[32mmet\033[0m"));
  EXPECT_THAT(colored, HasSubstr("\033[31mMISSED\033[0m"));
}

TEST(RunDetails, HaveEveryMetricTheGoalsAndTheDirectory) {
  const std::string text = run_details("street/patrol, seed 1", verdict_with({check("pose.ate_rmse_m", true)}),
                                       "out/run", TextStyle::kPlain);
  EXPECT_THAT(text, HasSubstr("pose.heading_rmse_deg"));
  EXPECT_THAT(text, HasSubstr("goal_1          2"));
  EXPECT_THAT(text, HasSubstr("run directory: out/run\n"));
}

TEST(RunJson, HasStatusMetricsAndDirectory) {
  const io::Metrics json = run_json(verdict_with({check("map.coverage", false)}), "out/run");
  EXPECT_EQ(json.at("end"), "expectation missed");
  EXPECT_EQ(json.at("exit_code"), 1);
  EXPECT_EQ(json.at("directory"), "out/run");
  EXPECT_EQ(json.at("metrics").at("pose").at("ate_rmse_m"), 0.0712);
}

}  // namespace
}  // namespace patrol::app::run_summary_test
