#include "studies/study_results.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/csv.h"

namespace patrol::studies::study_results_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Two methods, of which the second is always 1 better, with noise that both share.
Study two_methods() {
  Study study{.name = "two", .title = "Two methods", .source = "a paper", .conditions = "None."};
  study.metrics = {{.name = "RMSE", .unit = "m", .is_compared = true},
                   {.name = "NEES", .unit = ""},
                   {.name = "time", .unit = "s", .is_processor_time = true}};
  study.variants = {{.world = "flat", .method = "old", .particles = 10, .reference = 0, .published = {3.5}},
                    {.world = "flat", .method = "new", .particles = 10, .reference = 0}};
  study.illustrate = [](std::uint64_t) { return std::vector<report::Section>{}; };
  return study;
}

std::vector<StudySample> samples() {
  return {{{2.0, 5.0, 0.1}, {1.0, kNothing, 0.2}},
          {{4.0, 7.0, 0.3}, {3.1, kNothing, 0.4}},
          {{6.0, 9.0, 0.5}, {4.9, kNothing, 0.6}}};
}

TEST(StudyResults, DifferencesArePairedBySeedSoThatSharedNoiseFallsOut) {
  const StudyResults results = summarize(two_methods(), samples());
  EXPECT_DOUBLE_EQ(results[0][0].mean, 4.0);
  // Differences -1, -0.9, -1.1: mean -1, deviation 0.1; t(0.975, 2) = 4.303, half width 4.303 0.1 / sqrt 3 = 0.248.
  ASSERT_TRUE(results[1][0].difference);
  EXPECT_NEAR(results[1][0].difference->center, -1.0, 1e-12);
  EXPECT_NEAR(results[1][0].difference->high, -1.0 + 0.2484, 1e-4);
  EXPECT_EQ(verdict_of(results[1][0]), "lower");
  // The means themselves, 4 and 3, have deviations of 2: side by side they would say nothing.
  EXPECT_TRUE(results[0][0].interval->contains(3.0));
}

TEST(StudyResults, ZeroWithinTheIntervalIsNoDifferenceAndTheReferenceIsNotCompared) {
  std::vector<StudySample> level = samples();
  for (std::size_t seed = 0; seed < level.size(); ++seed)
    level[seed][1][0] = level[seed][0][0] + (seed == 0 ? 0.1 : -0.05);
  const StudyResults results = summarize(two_methods(), level);
  EXPECT_EQ(verdict_of(results[1][0]), "no difference");
  EXPECT_EQ(verdict_of(results[0][0]), "");
}

TEST(StudyResults, ProcessorTimeHasItsOwnTableAndUnmeasuredMetricsHaveNoRow) {
  const Study study = two_methods();
  const StudyResults results = summarize(study, samples());
  const std::string csv = io::to_csv(results_table(study, results));
  EXPECT_THAT(csv, HasSubstr("flat,old,10,RMSE,m,3.5,3,4,"));
  EXPECT_THAT(csv, HasSubstr("flat,old,10,NEES,,,3,7,"));
  EXPECT_THAT(csv, Not(HasSubstr("flat,new,10,NEES")));
  EXPECT_THAT(csv, Not(HasSubstr("time")));
  EXPECT_THAT(io::to_csv(performance_table(study, results)), HasSubstr("flat,new,10,time,s,0.4"));
  EXPECT_THAT(io::to_csv(samples_table(study, {1001, 1002, 1003}, samples())), HasSubstr("1002,flat,new,10,3.1,\r\n"));
}

/// One reference and `count` others, each with differences of mean -1 and the same p-value.
Study many_methods(std::size_t count) {
  Study study = two_methods();
  study.metrics.resize(1);
  study.variants.resize(1);
  for (std::size_t i = 0; i < count; ++i) study.variants.push_back({.world = "flat", .method = "new", .reference = 0});
  return study;
}

// The difference of `samples` has t = -1 / (0.1 / sqrt 3) = -17.3 with two degrees of freedom: p = 1 - t / sqrt(t^2 +
// 2) = 0.00332. Alone and among 15 it is significant; among 16 the smallest adjusted p-value is 0.053.
TEST(StudyResults, DifferencesAreCorrectedForTheNumberOfComparisonsOfTheStudy) {
  for (const std::size_t count : {1U, 15U, 16U}) {
    std::vector<StudySample> all;
    for (const StudySample& sample : samples()) {
      StudySample& extended = all.emplace_back(StudySample{{sample[0][0]}});
      for (std::size_t i = 0; i < count; ++i) extended.push_back({sample[1][0]});
    }
    const Study study = many_methods(count);
    const StudyResults results = summarize(study, all);
    const double t = std::sqrt(300.0), p = 1.0 - t / std::sqrt(t * t + 2.0);
    EXPECT_NEAR(results[1][0].adjusted_p_value.value(), static_cast<double>(count) * p, 1e-9) << count;
    EXPECT_EQ(verdict_of(results[1][0]), count < 16 ? "lower" : "no difference") << count;
    const ComparisonCount counted = count_comparisons(study, results);
    EXPECT_EQ(counted.num_comparisons, count);
    EXPECT_EQ(counted.num_uncorrected, count);
    EXPECT_EQ(counted.num_significant, count < 16 ? count : 0U);
  }
}

// Ten seeds; the second method fails on eight on which the first does not: p = 2 / 2^8, times two in the family.
TEST(StudyResults, FailedRunsAreCountedAndTheirRatesCompared) {
  std::vector<StudySample> all;
  for (int seed = 0; seed < 10; ++seed) all.push_back({{1.0 + 0.1 * seed}, {seed < 2 ? 2.0 + 0.3 * seed : kNothing}});
  const Study study = many_methods(1);
  const StudyResults results = summarize(study, all);
  EXPECT_EQ(results[0][0].num_failed, 0U);
  EXPECT_EQ(results[1][0].num_failed, 8U);
  EXPECT_EQ(results[1][0].num_paired, 2U);
  EXPECT_NEAR(results[1][0].adjusted_failure_p_value.value(), 2.0 * 2.0 / 256.0, 1e-12);
  EXPECT_EQ(count_comparisons(study, results).num_failure_differences, 1U);
  EXPECT_THAT(results_text(study, results), HasSubstr("8 *"));
  EXPECT_THAT(results_text(study, results), HasSubstr("Failed runs: 8"));
}

TEST(StudyResults, TextContainsPublishedValuesAndOwnMeans) {
  const Study study = two_methods();
  const std::string text = results_text(study, summarize(study, samples()));
  EXPECT_THAT(text, HasSubstr("3.5"));
  EXPECT_THAT(text, HasSubstr("-1 [-1.25, -0.752]"));
}

}  // namespace
}  // namespace patrol::studies::study_results_test
