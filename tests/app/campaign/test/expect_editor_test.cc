#include "app/campaign/test/expect_editor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::expect_editor_test {
namespace {

using ::testing::HasSubstr;

const io::Expectations kWanted = {{"pose.ate_rmse_m", {.min = 0.001, .max = 0.02}}, {"map.coverage", {.min = 0.7}}};
const std::map<std::string, std::string> kMeasured = {{"pose.ate_rmse_m", "measured 0.003 to 0.01"}};

std::string edit(const std::string& text) { return edit_expect_section("a.yaml", text, kWanted, kMeasured); }

TEST(ExpectEditor, ReplacesValuesAndKeepsEverythingElse) {
  EXPECT_EQ(edit("# A scenario.\n"
                 "world: street\n"
                 "expect:  # seeds 1 to 4\n"
                 "  mission.completed: true\n"
                 "\n"
                 "  # Position:\n"
                 "  pose.ate_rmse_m: {max: 0.08}\n"
                 "  map.nearest_mean_m: {max: 0.05}  # cells of 5 cm\n"
                 "wind: {speed_mps: 1.5}\n"),
            "# A scenario.\n"
            "world: street\n"
            "expect:  # seeds 1 to 4\n"
            "  mission.completed: true\n"
            "\n"
            "  # Position:\n"
            "  pose.ate_rmse_m: {min: 0.001, max: 0.02}  # measured 0.003 to 0.01\n"
            "  map.nearest_mean_m: {max: 0.05}  # cells of 5 cm\n"
            "  map.coverage: {min: 0.7}\n"
            "wind: {speed_mps: 1.5}\n");
}

TEST(ExpectEditor, AnOldRangeIsReplacedAndAnotherCommentIsNot) {
  EXPECT_THAT(edit("expect:\n  pose.ate_rmse_m: {max: 0.08}  # measured 0.1 to 0.2\n"),
              HasSubstr("pose.ate_rmse_m: {min: 0.001, max: 0.02}  # measured 0.003 to 0.01\n"));
  EXPECT_THAT(edit("expect:\n  pose.ate_rmse_m: {max: 0.08}  # why\n"),
              HasSubstr("pose.ate_rmse_m: {min: 0.001, max: 0.02}  # why\n"));
}

TEST(ExpectEditor, EditedTwiceItIsTheSame) {
  const std::string once = edit("world: street\nexpect:\n    pose.ate_rmse_m: 0.5\n");
  EXPECT_EQ(edit(once), once);
}

TEST(ExpectEditor, ASectionIsAddedIfThereIsNone) {
  EXPECT_EQ(edit("world: street\n"),
            "world: street\n"
            "expect:\n"
            "  pose.ate_rmse_m: {min: 0.001, max: 0.02}  # measured 0.003 to 0.01\n"
            "  map.coverage: {min: 0.7}\n");
}

TEST(ExpectEditor, RefusesOtherFormsWithTheirLine) {
  for (const char* text : {"a: 1\nexpect: {mission.completed: true}\n", "expect:\n  pose.ate_rmse_m:\n    max: 0.08\n",
                           "expect:\n  pose.ate_rmse_m: {max: 0.08,\n    min: 0.01}\n"}) {
    try {
      edit(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.yaml:2: expect: cannot be edited"));
    }
  }
}

}  // namespace
}  // namespace patrol::app::expect_editor_test
