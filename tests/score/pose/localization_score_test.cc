#include "score/pose/localization_score.h"

#include <gtest/gtest.h>

namespace patrol::score::localization_score_test {
namespace {

using namespace std::chrono_literals;

MatchedPose off_by(Time stamp, double error_m) {
  return {.stamp = stamp, .T_world_estimate = {error_m, 0.0, 0.0}, .T_world_truth = {}};
}

LocalizationConfidence confidence(Time stamp, double value, bool is_lost = false) {
  return {.stamp = stamp, .confidence = value, .is_lost = is_lost};
}

TEST(LocalizationScore, SaysWhenItDoubtedAndWhenItStrayed) {
  const LocalizationScore score =
      localization_score({off_by(1s, 0.1), off_by(2s, 0.4), off_by(3s, 0.6)},
                         {confidence(1s, 0.9), confidence(2s, 0.4), confidence(3s, 0.3)}, 4s);
  EXPECT_DOUBLE_EQ(score.max_error_m, 0.6);
  EXPECT_DOUBLE_EQ(score.min_confidence, 0.3);
  EXPECT_DOUBLE_EQ(*score.low_confidence_at_s, 2.0);
  EXPECT_DOUBLE_EQ(*score.error_exceeded_at_s, 3.0);
  EXPECT_DOUBLE_EQ(score.lost_s, 0.0);
}

TEST(LocalizationScore, WhatItSaysItDoesNotKnowIsNotHeldAgainstIt) {
  const LocalizationScore score =
      localization_score({off_by(1s, 0.1), off_by(2s, 9.0), off_by(4s, 0.2)},
                         {confidence(1s, 0.9), confidence(2s, 0.0, true), confidence(4s, 0.9)}, 5s);
  EXPECT_DOUBLE_EQ(score.max_error_m, 0.2);
  EXPECT_DOUBLE_EQ(score.max_error_with_lost_m, 9.0);
  EXPECT_FALSE(score.error_exceeded_at_s.has_value());
  EXPECT_DOUBLE_EQ(score.lost_s, 2.0);
}

TEST(LocalizationScore, CountsLostTimeUpToTheEndOfTheRunWhenNoReportFollows) {
  const std::vector<LocalizationConfidence> confidences = {confidence(1s, 0.9), confidence(3s, 0.0, true)};
  EXPECT_DOUBLE_EQ(localization_score({off_by(1s, 0.1)}, confidences, 10s).lost_s, 7.0);
  EXPECT_DOUBLE_EQ(localization_score({off_by(1s, 0.1)}, confidences, 2s).lost_s, 0.0) << "the end precedes the report";
}

TEST(RelocalizationScore, CountsFromTheKidnapToThePlaceThatItKeeps) {
  const std::vector<LocalizationConfidence> confidences = {confidence(9s, 1.0), confidence(11s, 0.0, true),
                                                           confidence(13s, 0.9)};
  std::vector<MatchedPose> matched = {off_by(9s, 0.0), off_by(10s, 20.0), off_by(12s, 0.1)};
  for (int second = 13; second < 25; ++second)
    matched.push_back(off_by(std::chrono::seconds(second), second == 14 ? 3.0 : 0.1));
  const RelocalizationScore score = relocalization_score(10s, Time::max(), matched, confidences);
  EXPECT_DOUBLE_EQ(score.displacement_m, 20.0);
  EXPECT_DOUBLE_EQ(*score.time_to_detect_s, 1.0);
  EXPECT_DOUBLE_EQ(*score.relocalized_s, 5.0);  // at 13 s it was right, at 14 s no more
}

TEST(RelocalizationScore, ARobotThatNeverFindsItsPlaceHasNone) {
  const RelocalizationScore score =
      relocalization_score(1s, Time::max(), {off_by(2s, 20.0), off_by(9s, 20.0)}, {confidence(1s, 1.0)});
  EXPECT_FALSE(score.relocalized_s.has_value());
  EXPECT_FALSE(score.time_to_detect_s.has_value());
}

TEST(RelocalizationScore, AnEstimateThatIsRightForLessThan5SecondsIsNotRelocalized) {
  const std::vector<LocalizationConfidence> confidences = {confidence(1s, 1.0)};
  const auto right_until = [&](Time end) {
    return relocalization_score(1s, Time::max(), {off_by(2s, 20.0), off_by(4s, 0.1), off_by(end, 0.1)}, confidences);
  };
  EXPECT_FALSE(right_until(8s).relocalized_s.has_value());
  EXPECT_DOUBLE_EQ(right_until(9s).relocalized_s.value_or(0.0), 3.0);
}

TEST(RelocalizationScore, EndsAtTheNextKidnap) {
  const std::vector<LocalizationConfidence> confidences = {confidence(1s, 1.0), confidence(9s, 0.0, true),
                                                           confidence(10s, 1.0)};
  std::vector<MatchedPose> matched = {off_by(2s, 20.0)};
  for (int second = 10; second < 20; ++second) matched.push_back(off_by(std::chrono::seconds(second), 0.1));
  const RelocalizationScore first = relocalization_score(1s, 8s, matched, confidences);
  EXPECT_DOUBLE_EQ(first.displacement_m, 20.0);
  EXPECT_FALSE(first.time_to_detect_s.has_value());
  EXPECT_FALSE(first.relocalized_s.has_value());
  const RelocalizationScore second = relocalization_score(8s, Time::max(), matched, confidences);
  EXPECT_DOUBLE_EQ(second.time_to_detect_s.value_or(0.0), 1.0);
  EXPECT_DOUBLE_EQ(second.relocalized_s.value_or(0.0), 2.0);
}

}  // namespace
}  // namespace patrol::score::localization_score_test
