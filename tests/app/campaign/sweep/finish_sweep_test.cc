#include "app/campaign/sweep/finish_sweep.h"

#include <gtest/gtest.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::finish_sweep_test {
namespace {

/// Two seeds of "baseline", "no noise" and "all ideal", with results of their own.
SweepManifest small_budget(const std::string& scenario) {
  SweepManifest manifest;
  manifest.kind = SweepKind::kBudget;
  manifest.scenario = scenario;
  manifest.variants = {{.name = "baseline", .overrides = {}},
                       {.name = "no noise", .overrides = {}},
                       {.name = "all ideal", .overrides = {}}};
  manifest.seeds = {1, 2};
  manifest.metrics = {"pose.ate_rmse_m"};
  for (std::size_t run = 0; run < 6; ++run) {
    manifest.runs.push_back(
        {.variant = run % 3, .seed = run / 3 + 1, .overrides = {}, .hash = "run" + std::to_string(run)});
  }
  return manifest;
}

SweepDirectory finished(const std::filesystem::path& root, const SweepManifest& manifest) {
  const SweepDirectory directory = begin_sweep_directory(root, manifest);
  for (std::size_t run = 0; run < manifest.runs.size(); ++run) {
    const double error_m = 0.1 - 0.02 * static_cast<double>(run % 3) + 0.001 * static_cast<double>(run);
    directory.store().save(manifest.runs[run].hash, {.end = RunStatus::kDone,
                                                     .message = "",
                                                     .metrics = {{"pose", {{"ate_rmse_m", error_m}}}},
                                                     .checks = {},
                                                     .events = {}});
  }
  EXPECT_EQ(finish_sweep(directory, manifest, ResultForm::kText), ExitCode::kDone);
  return directory;
}

TEST(FinishSweep, ABudgetsTableIsThereAndCollectWritesTheSameAgain) {
  const test::TemporaryFolder folder;
  const SweepDirectory directory = finished(folder / "budget", small_budget("a.yaml"));
  const std::string table = test::read_bytes(directory.table("budget")), sqlite = test::read_bytes(directory.sqlite());
  EXPECT_EQ(merge_command({.root = directory.root, .parts = {}}), ExitCode::kDone);
  EXPECT_EQ(test::read_bytes(directory.table("budget")), table);
  EXPECT_EQ(test::read_bytes(directory.sqlite()), sqlite);
}

TEST(FinishSweep, WithoutTheOthersAShardFailsByItsFailedRunsAlone) {
  const test::TemporaryFolder folder;
  const SweepManifest manifest = small_budget("a.yaml");
  const SweepDirectory directory = begin_sweep_directory(folder / "budget", manifest);
  const auto save = [&](std::size_t run, RunStatus end) {
    directory.store().save(manifest.runs[run].hash,
                           {.end = end, .message = "", .metrics = {}, .checks = {}, .events = {}});
  };
  const auto code_of_shard = [&](std::size_t index) {
    return finish_sweep(directory, manifest, ResultForm::kText, {.index = index, .count = 3});
  };
  save(0, RunStatus::kDone);
  save(3, RunStatus::kExpectationMissed);
  save(1, RunStatus::kCrashed);
  save(4, RunStatus::kWrongInput);
  save(2, RunStatus::kWrongInput);
  EXPECT_EQ(code_of_shard(0), ExitCode::kDone);
  EXPECT_EQ(code_of_shard(1), ExitCode::kProgramFailed);
  EXPECT_EQ(code_of_shard(2), ExitCode::kWrongInput);
}

TEST(FinishSweep, APartOfAnotherSweepIsRefusedAndWhatIsCompleteStaysSo) {
  const test::TemporaryFolder folder;
  const SweepDirectory directory = finished(folder / "budget", small_budget("a.yaml"));
  const SweepDirectory other = finished(folder / "other", small_budget("b.yaml"));
  EXPECT_THROW(merge_command({.root = directory.root, .parts = {other.root}}), InputError);
  EXPECT_THROW(merge_command({.root = directory.root, .parts = {folder / "nowhere"}}), InputError);
  EXPECT_TRUE(std::filesystem::exists(directory.table("budget")));
  EXPECT_FALSE(std::filesystem::exists(incomplete_marker(directory.root)));
}

}  // namespace
}  // namespace patrol::app::finish_sweep_test
