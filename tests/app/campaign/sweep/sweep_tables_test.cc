#include "app/campaign/sweep/sweep_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/csv.h"

namespace patrol::app::sweep_tables_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SweepManifest two_by_two() {
  SweepManifest manifest{.scenario = "s.yaml",
                         .overrides = {},
                         .paths = {"a", "drawn"},
                         .variants = {{.name = "a=1", .overrides = {"a=1"}}, {.name = "a=2", .overrides = {"a=2"}}},
                         .seeds = {1, 2},
                         .metrics = {"pose.ate_rmse_m"},
                         .stop = {},
                         .runs = {}};
  for (const std::uint64_t seed : manifest.seeds) {
    for (std::size_t variant = 0; variant < 2; ++variant) {
      manifest.runs.push_back({.variant = variant,
                               .seed = seed,
                               .overrides = {manifest.variants[variant].overrides[0], "drawn=0.5"},
                               .hash = "x"});
    }
  }
  return manifest;
}

RunVerdict row_with(double ate_m, double wall_s) {
  return {.end = RunStatus::kDone,
          .message = "",
          .metrics = {{"mission", {{"completed", true}}},
                      {"pose", {{"ate_rmse_m", ate_m}}},
                      {"performance", {{"wall_s", wall_s}}}},
          .checks = {},
          .events = {}};
}

SweepRows rows_taking(double wall_s) {
  return {row_with(0.1, wall_s), row_with(0.2, wall_s), row_with(0.3, wall_s), row_with(0.5, wall_s)};
}

TEST(RunsTable, IsTheSameWhateverTheClockSaid) {
  const SweepManifest manifest = two_by_two();
  const auto csv = [&](double wall_s) {
    const SweepRows rows = rows_taking(wall_s);
    return io::to_csv(runs_table(manifest, rows, evaluate_progress(manifest, rows)));
  };
  EXPECT_EQ(csv(1.0), csv(2.0));
  EXPECT_THAT(csv(1.0),
              HasSubstr("variant,a,drawn,seed,hash,end,exit_code,message,mission.completed,pose.ate_rmse_m\r\n"
                        "a=1,1,0.5,1,x,done,0,,1,0.1\r\n"));
}

TEST(RunsTable, ACrashedRunIsARowWithEmptyCells) {
  const SweepManifest manifest = two_by_two();
  SweepRows rows = rows_taking(1.0);
  rows[0] = RunVerdict{.end = RunStatus::kCrashed, .message = "signal 11", .metrics = {}, .checks = {}, .events = {}};
  EXPECT_THAT(io::to_csv(runs_table(manifest, rows, evaluate_progress(manifest, rows))),
              HasSubstr("a=1,1,0.5,1,x,crashed,3,signal 11,,\r\n"));
}

TEST(ComparisonTable, SaysThePairedDifference) {
  // Differences 0.1 and 0.2: mean 0.15, standard deviation 0.0707, t(1) = 12.71: half width 0.635; t = 3, p = 0.205.
  const SweepManifest manifest = two_by_two();
  const SweepRows rows = rows_taking(1.0);
  const io::Table table = comparison_table(manifest, rows, evaluate_progress(manifest, rows));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_NEAR(std::get<double>(table.rows[1][8]), 0.15, 1e-12);
  EXPECT_NEAR(std::get<double>(table.rows[1][10]), 0.15 + 0.6353, 1e-4);
  EXPECT_NEAR(std::get<double>(table.rows[1][11]), 0.2048, 1e-4);
  EXPECT_EQ(std::get<std::string>(table.rows[1][12]), "no difference");
  EXPECT_THAT(comparison_text(manifest, rows, evaluate_progress(manifest, rows)), HasSubstr("no difference"));
}

// The metrics of a run whose stack crashed are those of a part of the mission.
TEST(ComparisonTable, LeavesOutRunsWhoseStackFailedAndHasTheirNumber) {
  const SweepManifest manifest = two_by_two();
  SweepRows rows = rows_taking(1.0);
  EXPECT_THAT(comparison_text(manifest, rows, evaluate_progress(manifest, rows)), Not(HasSubstr("failed")));
  rows[1]->end = rows[3]->end = RunStatus::kStackFailed;
  const io::Table table = comparison_table(manifest, rows, evaluate_progress(manifest, rows));
  EXPECT_THAT(io::to_csv(table), HasSubstr("pose.ate_rmse_m,a=2,0,2,,,,0,,,,,runs failed\r\n"));
  const std::string text = comparison_text(manifest, rows, evaluate_progress(manifest, rows));
  EXPECT_THAT(text, HasSubstr("2 of 2"));
  EXPECT_THAT(text, HasSubstr("runs failed"));
}

}  // namespace
}  // namespace patrol::app::sweep_tables_test
