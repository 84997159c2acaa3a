#pragma once

namespace patrol::app {

/// Exit codes of the program, an interface for scripts.
enum class ExitCode : int {
  kDone = 0,               ///< completed, every expectation met
  kExpectationMissed = 1,  ///< the run completed and an expectation was missed
  kWrongInput = 2,         ///< invalid input or command line
  kProgramFailed = 3,      ///< the simulation or the program failed
  kTimeLimit = 4,
  kNothingExecuted = 5,
};

/// More severe of two exit codes, in this order: program failure, invalid input, time limit, missed expectation.
inline ExitCode worse(ExitCode a, ExitCode b) {
  const auto severity = [](ExitCode code) {
    switch (code) {
      case ExitCode::kProgramFailed:
        return 4;
      case ExitCode::kWrongInput:
        return 3;
      case ExitCode::kTimeLimit:
        return 2;
      case ExitCode::kExpectationMissed:
        return 1;
      default:
        return 0;
    }
  };
  return severity(b) > severity(a) ? b : a;
}

}  // namespace patrol::app
