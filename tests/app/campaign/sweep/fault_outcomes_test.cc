#include "app/campaign/sweep/fault_outcomes.h"

#include <gtest/gtest.h>

#include "tests/app/campaign/sweep/fault_verdict.h"

namespace patrol::app::fault_outcomes_test {
namespace {

using test::fault_verdict;

TEST(FaultOutcome, IsTheWorstThatHappened) {
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kDone, true, 0)), FaultOutcome::kSurvived);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kExpectationMissed, true, 0)), FaultOutcome::kDegraded);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kTimeLimit, false, 0)), FaultOutcome::kStopped);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kDone, true, 1)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of(fault_verdict(RunStatus::kFall, false, 0)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of({.end = RunStatus::kCrashed, .message = "", .metrics = {}, .checks = {}, .events = {}}),
            FaultOutcome::kNoResult);
}

}  // namespace
}  // namespace patrol::app::fault_outcomes_test
