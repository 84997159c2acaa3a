#include "app/campaign/sweep/fault_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/campaign/sweep/fault_verdict.h"

namespace patrol::app::fault_tables_test {
namespace {

using test::fault_verdict;
using ::testing::HasSubstr;

TEST(FaultTables, SaysWhatBecameOfEachFaultAndWhatItCost) {
  SweepManifest manifest;
  manifest.variants = {{.name = "no fault", .overrides = {}},
                       {.name = "imu: drift", .overrides = {}},
                       {.name = "uwb: freeze", .overrides = {}}};
  manifest.seeds = {1};
  manifest.metrics = {"pose.ate_rmse_m"};
  for (std::size_t i = 0; i < 3; ++i) manifest.runs.push_back({.variant = i, .seed = 1, .overrides = {}, .hash = ""});
  SweepRows rows = {fault_verdict(RunStatus::kDone, true, 0), fault_verdict(RunStatus::kTimeLimit, false, 0),
                    fault_verdict(RunStatus::kDone, true, 0, false)};
  rows[0]->events.clear();
  rows[1]->metrics["pose"]["ate_rmse_m"] = 0.3;

  const io::Table table = faults_table(manifest, rows);
  EXPECT_EQ(table.rows[1][4], io::TableValue("stopped"));
  EXPECT_EQ(table.rows[2][2], io::TableValue("not triggered"));
  EXPECT_NEAR(std::get<double>(table.rows[1].back()), 0.2, 1e-12);
  EXPECT_THAT(faults_text(manifest, rows),
              HasSubstr("3 runs: 2 survived, 1 stopped; 1 faults not triggered, 0 without effect."));
}

TEST(FaultTables, FaultsWithoutEffectAreMarkedInTheirRowsOfFileAndText) {
  SweepManifest manifest;
  manifest.variants = {{.name = "no fault", .overrides = {}},
                       {.name = "imu: drift", .overrides = {}},
                       {.name = "tdlas: dropout", .overrides = {}},
                       {.name = "uwb: freeze", .overrides = {}}};
  manifest.seeds = {1};
  manifest.metrics = {"pose.ate_rmse_m"};
  for (std::size_t i = 0; i < 4; ++i) manifest.runs.push_back({.variant = i, .seed = 1, .overrides = {}, .hash = ""});
  SweepRows rows = {fault_verdict(RunStatus::kDone, true, 0), fault_verdict(RunStatus::kDone, true, 0),
                    fault_verdict(RunStatus::kDone, true, 0), fault_verdict(RunStatus::kDone, true, 0, false)};
  rows[0]->events.clear();
  rows[1]->metrics["pose"]["ate_rmse_m"] = 0.3;

  const io::Table table = faults_table(manifest, rows);
  EXPECT_EQ(table.columns[3], "effect");
  const std::vector<std::string> effects = {"", "effect", "no effect", ""};
  for (std::size_t row = 0; row < 4; ++row) EXPECT_EQ(table.rows[row][3], io::TableValue(effects[row])) << row;
  const std::string text = faults_text(manifest, rows);
  EXPECT_THAT(text, HasSubstr("4 runs: 4 survived; 1 faults not triggered, 1 without effect."));
  EXPECT_THAT(text.substr(text.find("tdlas: dropout"), 70), HasSubstr("triggered      no effect  survived"));
}

TEST(FaultTables, ADocumentHasSensorsDownKindsAcrossAndTheWorstOfTheSeeds) {
  SweepManifest manifest;
  manifest.variants = {{.name = "no fault", .overrides = {}},
                       {.name = "imu: drift", .overrides = {}},
                       {.name = "imu: freeze", .overrides = {}}};
  manifest.seeds = {1, 2};
  manifest.metrics = {"pose.ate_rmse_m"};
  SweepRows rows;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    for (std::size_t variant = 0; variant < 3; ++variant) {
      manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
      rows.push_back(fault_verdict(RunStatus::kDone, true, 0));
    }
  }
  rows[4] = fault_verdict(RunStatus::kTimeLimit, false, 0);
  rows[4]->metrics["pose"]["ate_rmse_m"] = 0.3;
  EXPECT_THAT(
      faults_markdown(manifest, rows),
      HasSubstr("| pose.ate_rmse_m | drift | freeze |\n| --- | --- | --- |\n| no fault: survived 0.1, detected |\n"
                "| imu | **stopped** 0.3, detected | survived 0.1, no effect, detected |\n"));
  rows[2]->metrics["pose"]["ate_rmse_m"] = 0.101;
  EXPECT_THAT(faults_markdown(manifest, rows), HasSubstr("survived 0.101, detected |\n")) << "it had one with seed 1";
}

}  // namespace
}  // namespace patrol::app::fault_tables_test
