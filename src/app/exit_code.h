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

}  // namespace patrol::app
