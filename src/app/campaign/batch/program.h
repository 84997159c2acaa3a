#pragma once

#include <string>
#include <vector>

namespace patrol::app {

struct ProgramResult {
  int exit_code = 0;
  std::string output;  ///< standard output
};

/// Runs another program, found on the PATH, and waits for it. It inherits standard error. Throws std::runtime_error if
/// it cannot be started.
ProgramResult run_program(const std::vector<std::string>& words);

/// Quotes a word for the shell.
std::string quote_for_shell(const std::string& word);

}  // namespace patrol::app
