#include "app/campaign/sweep/comparison.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::app::comparison_test {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr const char* kMetric = "pose.ate_rmse_m";

SweepManifest manifest_of(std::size_t num_variants, std::size_t num_seeds, EarlyStop stop = {}) {
  SweepManifest manifest{.scenario = "s.yaml",
                         .overrides = {},
                         .paths = {},
                         .variants = std::vector<Variant>(num_variants),
                         .seeds = std::vector<std::uint64_t>(num_seeds),
                         .metrics = {kMetric},
                         .stop = stop,
                         .runs = {}};
  for (std::size_t seed = 0; seed < num_seeds; ++seed) {
    for (std::size_t variant = 0; variant < num_variants; ++variant)
      manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
  }
  return manifest;
}

RunVerdict row_with(double value) {
  return {.end = RunStatus::kDone,
          .message = "",
          .metrics = {{"pose", {{"ate_rmse_m", value}}}},
          .checks = {},
          .events = {}};
}

/// Rows with the value of `figure(variant, seed)` for every run.
template <typename Figure>
SweepRows rows_of(const SweepManifest& manifest, Figure figure) {
  SweepRows rows;
  for (const PlannedRun& run : manifest.runs) rows.emplace_back(row_with(figure(run.variant, run.seed)));
  return rows;
}

TEST(Compare, LeavesOutFailedRunsWithTheirPairs) {
  const SweepManifest manifest = manifest_of(2, 4);
  SweepRows rows = rows_of(manifest, [](std::size_t variant, std::uint64_t seed) {
    return static_cast<double>(seed) + 0.01 * static_cast<double>(variant);
  });
  rows[1]->end = RunStatus::kStackSilent;
  rows[1]->metrics["pose"]["ate_rmse_m"] = 100.0;
  rows[2]->end = RunStatus::kTimeLimit;  // such runs count
  const VariantMetric compared = compare(manifest, rows, kMetric, 4)[1];
  EXPECT_EQ(compared.num_failed, 1U);
  EXPECT_EQ(compared.failed_text(), "1 of 4");
  EXPECT_EQ(compared.num_pairs, 3U);
  EXPECT_NEAR(compared.difference->center, 0.01, 1e-12);
  EXPECT_EQ(compare(manifest, rows, kMetric, 4)[0].failed_text(), "0");
}

TEST(Compare, PairsCancelWhatSeedsShare) {
  // Seeds differ by whole metres, the variants by 0.01 m in every one of them: spread of the means large, of the
  // difference none.
  const SweepManifest manifest = manifest_of(2, 4);
  const SweepRows rows = rows_of(manifest, [](std::size_t variant, std::uint64_t seed) {
    return static_cast<double>(seed) + 0.01 * static_cast<double>(variant);
  });
  const std::vector<VariantMetric> compared = compare(manifest, rows, kMetric, 4);
  EXPECT_DOUBLE_EQ(compared[0].mean, 1.5);
  EXPECT_GT(compared[0].interval->high - compared[0].interval->low, 2.0);
  EXPECT_NEAR(compared[1].difference->center, 0.01, 1e-12);
  EXPECT_NEAR(compared[1].difference->high - compared[1].difference->low, 0.0, 1e-12);
  EXPECT_EQ(compared[1].verdict, "higher");
}

TEST(Compare, ThreePairsGiveTheTextbooksInterval) {
  // Differences 1, 2, 3: mean 2, standard deviation 1, t(2) = 4.3027: half width 4.3027 / sqrt(3) = 2.4841.
  const SweepManifest manifest = manifest_of(2, 3);
  const SweepRows rows = rows_of(manifest, [](std::size_t variant, std::uint64_t seed) {
    return variant == 0 ? 0.0 : static_cast<double>(seed) + 1.0;
  });
  const VariantMetric figure = compare(manifest, rows, kMetric, 3)[1];
  EXPECT_NEAR(figure.difference->center, 2.0, 1e-12);
  EXPECT_NEAR(figure.difference->low, 2.0 - 2.4841, 1e-4);
  EXPECT_NEAR(figure.difference->high, 2.0 + 2.4841, 1e-4);
  EXPECT_EQ(figure.verdict, "no difference");
}

// Differences 1, 2, 1.5: p = 0.035, which Holm's correction doubles where there is a second variant.
TEST(Compare, ADifferenceWithAPValueOfThreePercentIsOneAloneAndNoneAmongTwoVariants) {
  const double differences[] = {1.0, 2.0, 1.5};
  for (const std::size_t num_variants : {2, 3}) {
    const SweepManifest manifest = manifest_of(num_variants, 3);
    const SweepRows rows = rows_of(manifest, [&](std::size_t variant, std::uint64_t seed) {
      return variant == 1 ? differences[seed] : variant == 2 ? 0.1 * static_cast<double>(seed) - 0.1 : 0.0;
    });
    const VariantMetric metric = compare(manifest, rows, kMetric, 3)[1];
    EXPECT_FALSE(metric.difference->contains(0.0));
    EXPECT_EQ(metric.verdict, num_variants == 2 ? "higher" : "no difference");
  }
}

TEST(Compare, ARunWithoutTheFigureLeavesItsPairOut) {
  const SweepManifest manifest = manifest_of(2, 3);
  SweepRows rows =
      rows_of(manifest, [](std::size_t variant, std::uint64_t seed) { return static_cast<double>(seed + variant); });
  rows[3]->metrics = {};  // seed 1, variant 1: crashed
  const VariantMetric figure = compare(manifest, rows, kMetric, 3)[1];
  EXPECT_EQ(figure.num_runs, 2u);
  EXPECT_EQ(figure.num_pairs, 2u);
}

TEST(Compare, OnePairSaysTooLittle) {
  const SweepManifest manifest = manifest_of(2, 1);
  const SweepRows rows = rows_of(manifest, [](std::size_t, std::uint64_t) { return 1.0; });
  EXPECT_EQ(compare(manifest, rows, kMetric, 1)[1].verdict, "too few pairs");
}

TEST(Compare, EqualVariantsAreCalledDifferentInFivePercentOfSweeps) {
  constexpr int kSweeps = 2000;
  const SweepManifest manifest = manifest_of(2, 10);
  int found = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const RandomStream noise(static_cast<std::uint64_t>(sweep), "comparison_test");
    const SweepRows rows =
        rows_of(manifest, [&](std::size_t variant, std::uint64_t seed) { return noise.normal(seed, variant); });
    found += compare(manifest, rows, kMetric, 10)[1].verdict != "no difference" ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(found) / kSweeps, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / kSweeps));
}

TEST(Looks, AreAfterFiveTenTwentyAndAll) {
  EXPECT_THAT(interim_analyses(30), ElementsAre(5, 10, 20, 30));
  EXPECT_THAT(interim_analyses(5), ElementsAre(5));
  EXPECT_THAT(interim_analyses(3), ElementsAre(3));
}

TEST(Progress, WithoutEarlyStoppingEveryRunIsNeededAndCounts) {
  const SweepManifest manifest = manifest_of(2, 3);
  SweepRows rows(6);
  rows[4] = row_with(1.0);
  const SweepProgress progress = evaluate_progress(manifest, rows);
  EXPECT_THAT(progress.needed, ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(progress.counted, SizeIs(6));
}

TEST(Progress, FirstFiveSeedsAreNeededBeforeALook) {
  const SweepManifest manifest = manifest_of(2, 20, {.is_early = true, .equivalence_margin = 0.0});
  EXPECT_THAT(evaluate_progress(manifest, SweepRows(40)).needed, SizeIs(10));
}

TEST(Progress, AClearDifferenceStopsAfterFiveSeedsAndAnUnclearOneGoesOn) {
  const SweepManifest manifest = manifest_of(3, 20, {.is_early = true, .equivalence_margin = 0.0});
  const RandomStream noise(1, "comparison_test");
  SweepRows rows = rows_of(manifest, [&](std::size_t variant, std::uint64_t seed) {
    return (variant == 1 ? 10.0 : 0.0) + 0.1 * noise.normal(seed, variant);
  });
  for (std::size_t i = 15; i < rows.size(); ++i) rows[i].reset();  // five seeds of three variants were run
  const SweepProgress progress = evaluate_progress(manifest, rows);
  EXPECT_THAT(progress.num_seeds, ElementsAre(10, 5, 10));
  EXPECT_THAT(progress.needed, SizeIs(10));
}

TEST(Progress, WithinTheMarginEqualIsDecidedToo) {
  const SweepManifest manifest = manifest_of(2, 20, {.is_early = true, .equivalence_margin = 1.0});
  const RandomStream noise(1, "comparison_test");
  SweepRows rows =
      rows_of(manifest, [&](std::size_t variant, std::uint64_t seed) { return 0.01 * noise.normal(seed, variant); });
  for (std::size_t i = 10; i < rows.size(); ++i) rows[i].reset();
  const SweepProgress progress = evaluate_progress(manifest, rows);
  EXPECT_TRUE(progress.needed.empty());
  EXPECT_THAT(progress.counted, SizeIs(10));
}

TEST(Progress, LookingOftenFindsDifferencesBetweenEqualsInAtMostFivePercentOfSweeps) {
  constexpr int kSweeps = 2000;
  const SweepManifest manifest = manifest_of(2, 40, {.is_early = true, .equivalence_margin = 0.0});
  int stopped = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const RandomStream noise(static_cast<std::uint64_t>(sweep), "comparison_test");
    const SweepRows rows =
        rows_of(manifest, [&](std::size_t variant, std::uint64_t seed) { return noise.normal(seed, variant); });
    stopped += evaluate_progress(manifest, rows).num_seeds[1] < 40 ? 1 : 0;
  }
  EXPECT_LE(static_cast<double>(stopped) / kSweeps, 0.05);
}

}  // namespace
}  // namespace patrol::app::comparison_test
