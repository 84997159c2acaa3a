#include "slam/graph/survey_factors.h"

#include <gtest/gtest.h>

namespace patrol::slam::survey_factors_test {
namespace {

TEST(SurveyFactors, ConstrainASubmapIfARangeOrAPositionIsInIt) {
  SurveyFactors survey;
  EXPECT_FALSE(survey.constrain(0, 100));
  survey.ranges.add(4, {}, {}, {.anchor = {.number = 1, .p_m = {5.0, 0.0, 0.0}}, .range_m = 5.0, .T_odom_body = {}});
  survey.positions.add(20, {}, {.std_m = 0.01});
  EXPECT_TRUE(survey.constrain(0, 4));
  EXPECT_TRUE(survey.constrain(4, 10));
  EXPECT_FALSE(survey.constrain(5, 19));
  EXPECT_TRUE(survey.constrain(5, 20));
  EXPECT_FALSE(survey.constrain(21, 30));
}

}  // namespace
}  // namespace patrol::slam::survey_factors_test
