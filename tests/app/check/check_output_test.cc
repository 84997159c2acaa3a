#include "app/check/check_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/check/check_page.h"
#include "app/check/maneuver_figures.h"
#include "report/page.h"
#include "tests/app/check/straight_record.h"

namespace patrol::app::check_output_test {
namespace {

using testing::HasSubstr;
using testing::Not;

ManeuverResult result_of(const std::string& name, double slip_ratio) {
  ManeuverResult result;
  result.maneuver.name = name;
  result.maneuver.title = "Drive of " + name;
  result.record = test::straight_record(0.6, 0.6, 1.0);
  result.figures = {{.name = "slip_ratio", .value = slip_ratio, .max = 0.1, .limit_reason = "odometry", .is_key = true},
                    {.name = "stop_time_s", .value = 1.25}};
  result.failures = failures_of({}, result.maneuver, result.record, result.figures);
  return result;
}

CheckResult check_of(double slip_ratio) {
  CheckResult result;
  result.robot.name = "rover";
  result.robot.kind = DriveKind::kTracks;
  result.maneuvers = {result_of("straight", 0.01), result_of("turn", slip_ratio)};
  return result;
}

TEST(CheckOutput, TheTableHasOneLinePerManeuverAndTheReasonOfAFailureBelow) {
  const std::string table = check_table(check_of(0.3), TextStyle::kPlain);
  EXPECT_THAT(table, HasSubstr("rover, tracks"));
  EXPECT_THAT(table, HasSubstr("passed   straight        slip ratio 0.010\n"));
  EXPECT_THAT(table, HasSubstr("FAILED   turn            slip ratio 0.300\n"));
  EXPECT_THAT(table, HasSubstr("slip ratio 0.300: at most 0.100\n"));
  EXPECT_THAT(table, HasSubstr("1 of 2 maneuvers failed: turn.\n"));
}

TEST(CheckOutput, AWarningIsPrintedAboveTheVerdictAndIsInJsonAndPage) {
  CheckResult result = check_of(0.05);
  result.warnings = {"all beams of lidar hit the robot itself: its frame is enclosed in base_link"};
  EXPECT_THAT(check_table(result, TextStyle::kPlain),
              HasSubstr("\nwarning: " + result.warnings[0] + "\nAll 2 maneuvers passed.\n"));
  EXPECT_EQ(check_json(result)["warnings"][0], result.warnings[0]);
  EXPECT_THAT(report::to_html(check_page(result, {})), HasSubstr(result.warnings[0]));
}

TEST(CheckOutput, TheJsonHasFiguresLimitsAndVerdicts) {
  const io::Metrics json = check_json(check_of(0.3));
  EXPECT_EQ(json["verdict"], "failed");
  EXPECT_EQ(json["maneuvers"][0]["verdict"], "passed");
  const io::Metrics& turn = json["maneuvers"][1];
  EXPECT_EQ(turn["verdict"], "failed");
  EXPECT_DOUBLE_EQ(turn["figures"]["slip_ratio"], 0.3);
  EXPECT_DOUBLE_EQ(turn["limits"]["slip_ratio"]["max"], 0.1);
  EXPECT_EQ(turn["limits"]["slip_ratio"]["is_met"], false);
  EXPECT_FALSE(turn["limits"].contains("stop_time_s"));
}

TEST(CheckOutput, ThePageBeginsWithTheVerdictAndEmbedsThePictures) {
  const std::string html = report::to_html(check_page(check_of(0.3), {{.png = "png", .caption = "Robot & ramp"}}));
  EXPECT_LT(html.find("<p class=\"word\">Failed</p>"), html.find("Robot &amp; ramp"));
  EXPECT_LT(html.find("Robot &amp; ramp"), html.find("reason of the limit"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,"));
}

TEST(CheckOutput, ThePageOfAPassedCheckHasNoReasons) {
  const std::string html = report::to_html(check_page(check_of(0.05), {}));
  EXPECT_THAT(html, HasSubstr("<p class=\"word\">Passed</p>"));
  EXPECT_THAT(html, Not(HasSubstr("FAILED")));
}

}  // namespace
}  // namespace patrol::app::check_output_test
