#include "app/cli/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/cli/command_options.h"
#include "app/cli/number_checks.h"
#include "app/cli/renamed_options.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files/one_line.h"

namespace patrol::app {
namespace {

/// Throws InputError for an unknown command; the message of CLI11 would only be that a command is required.
void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  if (word.starts_with('-')) return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(word)) return;
    known.push_back(command->get_name());
  }
  throw InputError(fmt::format("unknown command '{}' (known: {})", word, join(known, ", ")));
}

/// Prints an error; does not throw if standard error is not writable.
int report(const std::string& what, ExitCode code) {
  std::fputs(fmt::format("patrol: {}\n", io::on_one_line(what)).c_str(), stderr);  // fmt::print would throw on failure
  return static_cast<int>(code);
}

/// Makes MuJoCo print its warnings and errors; it would write a file into the working directory. An error ends the
/// program: MuJoCo allows no return from it.
void print_messages_of_mujoco() {
  mju_user_warning = [](const char* text) { report(fmt::format("mujoco: {}", text), ExitCode::kDone); };
  mju_user_error = [](const char* text) {
    std::_Exit(report(fmt::format("mujoco: {}", text), ExitCode::kProgramFailed));
  };
}

/// Parses the command line and runs its command. Exceptions become one line on standard error.
int run_parsed(CLI::App& app, Call& call, int argc, const char* const* argv) {
  try {
    refuse_renamed(argc, argv);
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return static_cast<int>(call.chosen());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const InputError& error) {
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::kProgramFailed);
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  print_messages_of_mujoco();
  CLI::App app("Patrol: a digital twin for inspection robots");
  app.set_version_flag("--version", PATROL_VERSION);
  app.require_subcommand(1);
  Call call;
  add_run_commands(app, call);
  add_campaign_commands(app, call);
  add_mapping_commands(app, call);
  add_import_command(app, call);
  add_generate_command(app, call);
  add_site_command(app, call);
  add_program_commands(app, call);
  add_number_checks(app);

  const int code = run_parsed(app, call, argc, argv);
  const bool is_written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_written || code == static_cast<int>(ExitCode::kWrongInput) ||
      code == static_cast<int>(ExitCode::kProgramFailed))
    return code;
  return report(fmt::format("cannot write standard output: {}", std::strerror(errno)), ExitCode::kProgramFailed);
}

}  // namespace patrol::app
