#pragma once

namespace patrol::app {

/// Parses the command line, runs one command, and returns the exit code of the process (app/common/exit_code.h). Every
/// exception is reported as one line on standard error.
int run_command_line(int argc, const char* const* argv);

}  // namespace patrol::app
