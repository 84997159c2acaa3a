#include "app/campaign/sweep/fault_outcomes.h"

#include <gtest/gtest.h>

#include "tests/app/campaign/sweep/fault_verdict.h"

namespace patrol::app::fault_outcomes_test {
namespace {

using test::fault_verdict;

/// Fault matrix of one seed: a run without a fault, and one with a drift of GNSS.
SweepManifest one_fault_and_none() {
  SweepManifest manifest;
  manifest.variants = {{.name = "no fault", .overrides = {}}, {.name = "gnss: drift", .overrides = {}}};
  manifest.seeds = {1};
  for (std::size_t i = 0; i < 2; ++i) manifest.runs.push_back({.variant = i, .seed = 1, .overrides = {}, .hash = ""});
  return manifest;
}

TEST(FaultOutcome, IsTheWorstThatHappened) {
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kDone, true, 0)), FaultOutcome::kSurvived);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kExpectationMissed, true, 0)), FaultOutcome::kDegraded);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kTimeLimit, false, 0)), FaultOutcome::kStopped);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kDone, true, 1)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kFall, false, 0)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of({.end = RunStatus::kCrashed, .message = "", .metrics = {}, .checks = {}, .events = {}}),
            FaultOutcome::kNoResult);
}

TEST(FaultRow, HasNoEffectWhenOnlyTheNumberOfReportedFaultsAndThePerformanceDiffer) {
  const SweepManifest manifest = one_fault_and_none();
  SweepRows rows = {fault_verdict(RunStatus::kDone, true, 0), fault_verdict(RunStatus::kDone, true, 0)};
  rows[0]->events.clear();
  rows[0]->metrics["mission"]["sensor_faults_noticed"] = 0;
  rows[1]->metrics["performance"]["cpu_s"] = 7.0;
  EXPECT_FALSE(fault_rows(manifest, rows)[0].is_without_effect()) << "no fault";
  EXPECT_TRUE(fault_rows(manifest, rows)[1].is_without_effect());
  rows[1]->metrics["pose"]["ate_rmse_m"] = 0.1001;
  EXPECT_FALSE(fault_rows(manifest, rows)[1].is_without_effect());
}

TEST(FaultRow, AKidnapOfTheScenarioIsNoFault) {
  const SweepManifest manifest = one_fault_and_none();
  SweepRows rows = {fault_verdict(RunStatus::kDone, true, 0), fault_verdict(RunStatus::kDone, true, 0)};
  const InjectedEvent kidnap{.name = "kidnap at 900 s", .was_triggered = false};
  rows[0]->events = {kidnap};
  rows[1]->events.insert(rows[1]->events.begin(), kidnap);
  EXPECT_EQ(fault_rows(manifest, rows)[0].was_triggered, std::nullopt);
  EXPECT_EQ(fault_rows(manifest, rows)[1].was_triggered, true);
}

}  // namespace
}  // namespace patrol::app::fault_outcomes_test
