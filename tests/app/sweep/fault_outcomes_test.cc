#include "app/sweep/fault_outcomes.h"

#include <gtest/gtest.h>

#include "tests/app/sweep/fault_verdict.h"

namespace patrol::app::fault_outcomes_test {
namespace {

using test::fault_verdict;

TEST(FaultOutcome, IsTheWorstThatHappened) {
  EXPECT_EQ(outcome_of(fault_verdict("done", true, 0)), FaultOutcome::kSurvived);
  RunVerdict missed = fault_verdict("expectation missed", true, 0);
  missed.code = ExitCode::kExpectationMissed;
  EXPECT_EQ(outcome_of(missed), FaultOutcome::kDegraded);
  EXPECT_EQ(outcome_of(fault_verdict("time limit", false, 0)), FaultOutcome::kStopped);
  EXPECT_EQ(outcome_of(fault_verdict("done", true, 1)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of(fault_verdict("fall", false, 0)), FaultOutcome::kUnsafe);
  EXPECT_EQ(outcome_of({.end = "crashed", .code = ExitCode::kProgramFailed, .message = "", .metrics = {}, .checks = {}, .events = {}}),
            FaultOutcome::kNoResult);
}

}  // namespace
}  // namespace patrol::app::fault_outcomes_test
