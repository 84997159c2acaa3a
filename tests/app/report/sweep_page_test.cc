#include "app/report/sweep_page.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/report/comparison_blocks.h"

namespace patrol::app::sweep_page_test {
namespace {

using ::testing::HasSubstr;

/// Ten seeds of two variants; the second is `shift_m` worse, with a little noise of its own.
struct SmallSweep {
  explicit SmallSweep(double shift_m, SweepKind kind = SweepKind::kSweep) {
    manifest.kind = kind;
    manifest.scenario = "walk.yaml";
    manifest.variants = {{.name = "first", .overrides = {}}, {.name = "second", .overrides = {}}};
    manifest.metrics = {"pose.ate_rmse_m"};
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      manifest.seeds.push_back(seed);
      for (std::size_t variant = 0; variant < 2; ++variant) {
        manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
        const double noise_m = 0.001 * static_cast<double>(seed % 2 == 0 ? 1 : -1) * static_cast<double>(variant);
        const double error_m =
            0.05 + 0.01 * static_cast<double>(seed) + noise_m + shift_m * static_cast<double>(variant);
        rows.push_back(RunVerdict{
            .end = RunStatus::kDone,
            .message = "",
            .metrics = {{"pose", {{"ate_rmse_m", error_m}}}, {"mission", {{"completed", true}, {"collisions", 0}}}},
            .checks = {},
            .events = {}});
      }
    }
  }
  report::Page page() const { return sweep_page(manifest, rows, evaluate_progress(manifest, rows)); }
  report::VerdictBlock verdict() const {
    return std::get<report::VerdictBlock>(page().sections.front().blocks.front());
  }

  SweepManifest manifest;
  SweepRows rows;
};

TEST(SweepPage, ADifferenceIsSaidInTheVerdictWithItsDirection) {
  EXPECT_EQ(SmallSweep(0.02).verdict().word, "1 of 1 differ");
  EXPECT_THAT(SmallSweep(0.02).verdict().reason, HasSubstr("higher with second"));
  EXPECT_THAT(SmallSweep(-0.02).verdict().reason, HasSubstr("lower with second"));
}

TEST(SweepPage, AVariantWhoseRunsAllFailedHasNoDirection) {
  SmallSweep sweep(-0.02);
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    if (sweep.manifest.runs[i].variant == 1) sweep.rows[i]->end = RunStatus::kStackFailed;
  }
  EXPECT_EQ(sweep.verdict().word, "Runs failed");
  EXPECT_THAT(sweep.verdict().reason, HasSubstr("no comparison with first for second."));
}

TEST(SweepPage, AnIntervalThatHoldsZeroIsNoDifference) { EXPECT_EQ(SmallSweep(0.0).verdict().word, "No difference"); }

// Differences 1, 2 and 1.5 cm: p = 0.035. Of two variants, Holm's correction doubles it.
TEST(SweepPage, ADifferenceIsPaintedByItsVerdict) {
  SmallSweep sweep(0.0);
  sweep.manifest.variants.push_back({.name = "third", .overrides = {}});
  sweep.manifest.seeds = {1, 2, 3};
  sweep.manifest.runs.clear();
  sweep.rows.clear();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (std::size_t variant = 0; variant < 3; ++variant) {
      sweep.manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
      const double error_m = 0.1 + (variant == 1 ? std::array{0.01, 0.02, 0.015}[seed - 1] : 0.0);
      sweep.rows.push_back(RunVerdict{.end = RunStatus::kDone,
                                      .message = "",
                                      .metrics = {{"pose", {{"ate_rmse_m", error_m}}}},
                                      .checks = {},
                                      .events = {}});
    }
  }
  const report::Page page = sweep.page();
  const report::Span& span = std::get<report::WaterfallChart>(page.sections[1].blocks[1]).spans[0];
  EXPECT_GT(span.interval->first, 0.0);
  EXPECT_EQ(span.text, "no difference");
  EXPECT_EQ(span.tone, report::Tone::kFaint);
}

TEST(SweepPage, RunsThatFailedAreSaidAndStandFirst) {
  SmallSweep sweep(0.0);
  sweep.rows[7]->end = RunStatus::kCrashed;
  EXPECT_THAT(sweep.verdict().reason, HasSubstr("1 of 20 runs did not end as expected"));
  const report::Page page = sweep.page();
  const auto& runs = std::get<report::CollapsibleTables>(page.sections.back().blocks.front());
  EXPECT_EQ(runs.tables.front().rows.front()[2].text, "crashed");
}

TEST(SweepPage, LengthsAreInCentimetresAndEveryRunIsADot) {
  const report::Page page = SmallSweep(0.02).page();
  const auto& blocks = page.sections[1].blocks;
  const auto& boxes = std::get<report::BoxPlot>(blocks[0]);
  EXPECT_EQ(boxes.unit, "cm");
  EXPECT_EQ(boxes.boxes[0].values.size(), 10u);
  EXPECT_NEAR(boxes.boxes[0].median, 10.5, 1e-9);
  EXPECT_NEAR(std::get<report::WaterfallChart>(blocks[1]).spans[0].to, 2.0, 1e-9);
}

TEST(SweepPage, AFaultMatrixSaysHowManyWereUnsafe) {
  SmallSweep faults(0.0, SweepKind::kFaults);
  EXPECT_EQ(faults.verdict().word, "No fault was unsafe");
  faults.rows[1]->metrics["mission"]["collisions"] = 2;
  EXPECT_EQ(faults.verdict().word, "1 of 20 runs unsafe");
  EXPECT_THAT(faults.verdict().reason, HasSubstr("1 UNSAFE"));
}

TEST(SweepPage, AFaultWithoutEffectIsMarkedInItsRow) {
  SmallSweep faults(0.0, SweepKind::kFaults);
  faults.manifest.variants = {{.name = "no fault", .overrides = {}}, {.name = "imu: drift", .overrides = {}}};
  for (std::size_t i = 1; i < faults.rows.size(); i += 2) {
    faults.rows[i]->metrics = faults.rows[i - 1]->metrics;
    faults.rows[i]->events = {{.name = "fault imu drift at 12 s", .was_triggered = true}};
  }
  faults.rows[3]->metrics["pose"]["ate_rmse_m"] = 0.3;
  const report::Page page = faults.page();
  const auto& table = std::get<report::TableBlock>(page.sections[1].blocks[0]);
  EXPECT_EQ(table.columns[3].title, "effect");
  EXPECT_EQ(table.rows[0][3].text, "");
  EXPECT_EQ(table.rows[1][3].text, "no effect");
  EXPECT_EQ(table.rows[3][3].text, "effect");
}

TEST(SweepPage, ABudgetNamesTheOwnerAndItsWaterfallEndsAtTheIdeal) {
  SmallSweep budget(0.0, SweepKind::kBudget);
  budget.manifest.variants = {{.name = "baseline", .overrides = {}},
                              {.name = "lidar: range noise", .overrides = {}},
                              {.name = "all ideal", .overrides = {}}};
  budget.manifest.runs.clear();
  budget.rows.clear();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (std::size_t variant = 0; variant < 3; ++variant) {
      budget.manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
      const double error_m =
          std::array{0.10, 0.04, 0.03}[variant] + 0.001 * static_cast<double>(seed * (variant + 1) % 3);
      budget.rows.push_back(RunVerdict{.end = RunStatus::kDone,
                                       .message = "",
                                       .metrics = {{"pose", {{"ate_rmse_m", error_m}}}},
                                       .checks = {},
                                       .events = {}});
    }
  }
  EXPECT_EQ(budget.verdict().word, "lidar: range noise");
  const report::Page page = budget.page();
  const auto& spans = std::get<report::WaterfallChart>(page.sections[1].blocks[0]).spans;
  ASSERT_EQ(spans.size(), 4u);  // baseline, the contribution, the interaction, all ideal
  EXPECT_NEAR(spans[1].from, spans[0].to, 1e-9);
  EXPECT_NEAR(spans[2].from, spans[1].to, 1e-9);
  EXPECT_NEAR(spans[2].to, spans[3].to, 1e-9);
}

// Differences 1, 2 and 1.5 cm: p = 0.035. Of two sources, Holm's correction doubles it.
TEST(SweepPage, TheVerdictOfABudgetNamesNoSourceWhoseCorrectedPValueIsAboveFivePercent) {
  SmallSweep budget(0.0, SweepKind::kBudget);
  budget.manifest.variants.clear();
  for (const char* name : {"baseline", "lidar: range noise", "slip", "all ideal"})
    budget.manifest.variants.push_back({.name = name, .overrides = {}});
  budget.manifest.seeds = {1, 2, 3};
  budget.manifest.runs.clear();
  budget.rows.clear();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const double difference_m = std::array{0.01, 0.02, 0.015}[seed - 1];
    for (std::size_t variant = 0; variant < 4; ++variant) {
      const double error_m = std::array{0.10, 0.10 - difference_m, 0.10, 0.08}[variant];
      budget.manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
      budget.rows.push_back(RunVerdict{.end = RunStatus::kDone,
                                       .message = "",
                                       .metrics = {{"pose", {{"ate_rmse_m", error_m}}}},
                                       .checks = {},
                                       .events = {}});
    }
  }
  EXPECT_EQ(budget.verdict().word, "No significant contribution");
}

TEST(SweepPage, VariantsAreNamedByTheLastPartOfTheirKeysUnlessTwoAreAlike) {
  SweepManifest manifest;
  manifest.paths = {"sensors.lidar.range_noise_std_m", "stack.slam.rbpf.particles"};
  manifest.variants = {
      {.name = "long", .overrides = {"sensors.lidar.range_noise_std_m=0.01", "stack.slam.rbpf.particles=20"}}};
  EXPECT_EQ(short_names(manifest).front(), "range_noise_std_m=0.01, particles=20");
  manifest.paths = {"sensors.lidar.rate_hz", "sensors.imu.rate_hz"};
  manifest.variants = {{.name = "long", .overrides = {"sensors.lidar.rate_hz=5", "sensors.imu.rate_hz=100"}}};
  EXPECT_EQ(short_names(manifest).front(), "long");
}

}  // namespace
}  // namespace patrol::app::sweep_page_test
