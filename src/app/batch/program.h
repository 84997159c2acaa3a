#pragma once

#include <string>
#include <vector>

namespace patrol::app {

struct ProgramResult {
  int exit_code = 0;
  std::string output;  ///< standard output
};

/// Runs another program, found on the PATH, and waits for it. Its standard error is ours. Throws std::runtime_error when it cannot be
/// started.
ProgramResult run_program(const std::vector<std::string>& words);

/// A word as the shell reads it back.
std::string shell_quoted(const std::string& word);

}  // namespace patrol::app
