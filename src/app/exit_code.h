#pragma once

namespace patrol::app {

/// The program's exit codes; scripts build on them.
enum class ExitCode : int {
  kDone = 0,               ///< done, and every expectation met
  kExpectationMissed = 1,  ///< the run ended and an expectation was missed
  kWrongInput = 2,         ///< the input or the call was wrong
  kProgramFailed = 3,      ///< the simulation or the program failed
  kTimeLimit = 4,
  kNothingExecuted = 5,
};

/// Of two runs' verdicts the one that matters more: the program's failure, a wrong input, a time limit, a missed expectation, in this order.
inline ExitCode worse(ExitCode a, ExitCode b) {
  const auto severity = [](ExitCode code) {
    switch (code) {
      case ExitCode::kProgramFailed: return 4;
      case ExitCode::kWrongInput: return 3;
      case ExitCode::kTimeLimit: return 2;
      case ExitCode::kExpectationMissed: return 1;
      default: return 0;
    }
  };
  return severity(b) > severity(a) ? b : a;
}

}  // namespace patrol::app
