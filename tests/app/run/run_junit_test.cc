#include "app/run/run_junit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_file.h"

namespace patrol::app::run_junit_test {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

Scenario make_scenario() {
  Scenario scenario;
  scenario.world = "street";
  scenario.seed = 42;
  return scenario;
}

CheckedExpectation make_check(bool is_met) {
  return {.metric = "pose.ate_rmse_m",
          .wanted = "<= 0.08",
          .got = is_met ? "0.05" : "0.21",
          .is_measured = true,
          .is_met = is_met};
}

RunOutcome ended(RunEnd end, double duration_s, double wall_s = 0.0) {
  RunOutcome outcome;
  outcome.end = end;
  outcome.duration = from_seconds(duration_s);
  outcome.wall_s = wall_s;
  return outcome;
}

std::string saved(const io::JunitSuite& suite) {
  const TemporaryFolder folder;
  io::save_junit(folder / "junit.xml", {suite});
  return test::read_bytes(folder / "junit.xml");
}

/// The report of a run.
std::string report(const RunOutcome& outcome, const std::vector<CheckedExpectation>& checks) {
  const io::Metrics metrics = {{"performance", {{"wall_s", outcome.wall_s}}}};
  return saved(junit_suite("short", junit_properties(make_scenario()), verdict_of(outcome, {}, metrics, checks)));
}

TEST(RunJunit, BeforeTheRunHasEndedItIsRed) {
  const std::string xml = saved(unfinished_suite("short", junit_properties(make_scenario())));
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"short\""));
  EXPECT_THAT(xml, HasSubstr("errors=\"1\""));
  EXPECT_THAT(xml, HasSubstr("<error "));
  EXPECT_THAT(xml, HasSubstr("name=\"seed\" value=\"42\""));
}

TEST(RunJunit, ARunThatMetEverythingHasNoFailure) {
  const std::string xml = report(ended(RunEnd::kMissionOver, 60.0, 12.5), {make_check(true)});
  EXPECT_THAT(xml, HasSubstr("tests=\"2\" failures=\"0\" errors=\"0\" skipped=\"0\""));
  EXPECT_THAT(xml, HasSubstr("classname=\"short\" name=\"run\" time=\"12.500\"/>"));
  EXPECT_THAT(xml, HasSubstr("name=\"pose.ate_rmse_m &lt;= 0.08\""));
}

TEST(RunJunit, AMissedExpectationSaysWhatItGotAndWhatWasExpected) {
  const std::string xml = report({}, {make_check(true), make_check(false)});
  EXPECT_THAT(xml, HasSubstr("tests=\"3\" failures=\"1\" errors=\"0\""));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"pose.ate_rmse_m is 0.21, expected &lt;= 0.08\""));
}

TEST(RunJunit, AFallFailsAndSaysWhen) {
  const std::string xml = report(ended(RunEnd::kFall, 33.256), {});
  EXPECT_THAT(xml, HasSubstr("failures=\"1\""));
  EXPECT_THAT(xml, HasSubstr("the robot fell at 33.26 s"));
}

TEST(RunJunit, ATimeLimitFailsAndSaysWhich) {
  const std::string xml = report(ended(RunEnd::kTimeLimit, 120.0), {});
  EXPECT_THAT(xml, HasSubstr("failures=\"1\""));
  EXPECT_THAT(xml, HasSubstr("time limit: 120 s"));
}

// A fault that touched no message has tested nothing: neither green nor red.
TEST(RunJunit, FaultsThatWereNotExecutedAreSkipped) {
  RunOutcome outcome;
  outcome.faults = {{.fault = {.sensor = "lidar", .kind = "dropout", .start_s = 10.0}, .was_triggered = true},
                    {.fault = {.sensor = "imu", .kind = "freeze", .start_s = 900.0}, .was_triggered = false}};
  const std::string xml = report(outcome, {});
  EXPECT_THAT(xml, HasSubstr("tests=\"3\" failures=\"0\" errors=\"0\" skipped=\"1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"fault lidar dropout at 10 s\" time=\"0.000\"/>"));
  EXPECT_THAT(xml, HasSubstr("<skipped message=\"not triggered"));
}

TEST(RunJunit, NamesWhatIsNeededToRunItAgain) {
  const std::string xml = report({}, {});
  EXPECT_THAT(xml, HasSubstr("name=\"world\" value=\"street\""));
  EXPECT_THAT(xml, HasSubstr("name=\"robot\" value=\"quadruped\""));
  EXPECT_THAT(xml, HasSubstr("name=\"seed\" value=\"42\""));
  EXPECT_THAT(xml, Not(HasSubstr("name=\"version\" value=\"\"")));
}

TEST(RunJunit, ARunThatCrashedIsAnErrorAndNotAFailure) {
  const RunVerdict verdict{
      .end = RunStatus::kCrashed, .message = "signal 11", .metrics = {}, .checks = {}, .events = {}};
  const std::string xml = saved(junit_suite("short", {}, verdict));
  EXPECT_THAT(xml, HasSubstr("failures=\"0\" errors=\"1\""));
  EXPECT_THAT(xml, HasSubstr("crashed: signal 11"));
}

/// Status and message of a run's end as its report has them; "" for a run whose mission was over.
std::string read_back(const RunOutcome& outcome, const std::vector<CheckedExpectation>& checks) {
  const TemporaryFolder folder;
  const io::Metrics metrics = {{"performance", {{"wall_s", 1.0}}}};
  io::save_junit(folder / "junit.xml", {junit_suite("short", {}, verdict_of(outcome, {}, metrics, checks))});
  const std::optional<EarlyEnd> early = load_early_end(folder / "junit.xml");
  return early ? std::string(name_of(early->status)) + " | " + early->message : "";
}

TEST(LoadEarlyEnd, ReturnsStatusAndMessageOfEveryEarlyEnd) {
  EXPECT_EQ(read_back(ended(RunEnd::kFall, 33.256), {}), "fall | the robot fell at 33.26 s");
  EXPECT_EQ(read_back(ended(RunEnd::kTimeLimit, 120.0), {make_check(false)}), "time limit | 120 s");
  RunOutcome failed = ended(RunEnd::kStackFailed, 1.0);
  failed.stack_failure = "the stack failed at 1.000 s: fall: <none> & \"more\"";
  EXPECT_EQ(read_back(failed, {}), "stack failed | the stack failed at 1.000 s: fall: <none> & \"more\"");
  RunOutcome silent = ended(RunEnd::kStackSilent, 1.0);
  silent.stack_failure = "the stack was silent at 1.000 s: no answer within 5 s";
  EXPECT_EQ(read_back(silent, {}), "stack silent | the stack was silent at 1.000 s: no answer within 5 s");
}

TEST(LoadEarlyEnd, ReturnsNothingForAMissionThatIsOverAndWithoutAReport) {
  EXPECT_EQ(read_back({}, {make_check(true), make_check(false)}), "");
  EXPECT_FALSE(load_early_end("no/such/junit.xml").has_value());
}

TEST(LoadEarlyEnd, OfAReportWithoutAKnownStatusIsAFailure) {
  const TemporaryFolder folder;
  io::save_junit(folder / "junit.xml", {unfinished_suite("short", {})});
  const std::optional<EarlyEnd> early = load_early_end(folder / "junit.xml");
  ASSERT_TRUE(early.has_value());
  EXPECT_EQ(early->status, RunStatus::kFailed);
}

}  // namespace
}  // namespace patrol::app::run_junit_test
