#pragma once

namespace patrol::app {

/// The program: parses the call, runs one command, and gives the process's exit code (app/exit_code.h). Every exception
/// ends here as one line on standard error.
int run_command_line(int argc, const char* const* argv);

}  // namespace patrol::app
