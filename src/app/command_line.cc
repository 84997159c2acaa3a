#include "app/command_line.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/commands.h"
#include "core/error.h"

namespace patrol::app {
namespace {

/// Builds the parser; `chosen` is filled with the command that was called.
void add_commands(CLI::App& app, std::function<ExitCode()>& chosen, RunOptions& run, ScoreOptions& score,
                  ReplayOptions& replay, std::filesystem::path& verify_run) {
  CLI::App* command = app.add_subcommand("run", "Run a scenario headless and score it");
  command->add_option("scenario", run.scenario, "Scenario file (YAML)")->required();
  command->add_option("--set", run.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--seed", run.seed, "Seed of every random stream");
  command->add_option("--out", run.out, "Run directory to leave");
  command->callback([&] { chosen = [&] { return run_command(run); }; });

  command = app.add_subcommand("score", "Score a run, a trajectory or a map");
  command->add_option("run", score.run, "Run directory");
  command->add_option("--estimate", score.estimate, "Estimated trajectory (TUM)");
  command->add_option("--reference", score.reference, "Reference trajectory (TUM)");
  command->add_option("--map", score.map, "Built map (map_server YAML)");
  command->add_option("--reference-map", score.reference_map, "Reference map (map_server YAML)");
  command->callback([&] { chosen = [&] { return score_command(score); }; });

  command = app.add_subcommand("replay", "Render a run from its log");
  command->add_option("run", replay.run, "Run directory")->required();
  command->add_option("--camera", replay.camera, "chase, top or onboard")->capture_default_str();
  command->add_option("--speed", replay.speed, "Simulated seconds per second of video")->capture_default_str();
  command->add_option("--size", replay.size, "Width x height, pixels")->capture_default_str();
  command->add_option("--still", replay.still_s, "One picture (PNG) of this instant instead, s");
  command->add_option("--out", replay.out, "File to write");
  command->callback([&] { chosen = [&] { return replay_command(replay); }; });

  command = app.add_subcommand("verify", "Run a run again and name the first difference");
  command->add_option("run", verify_run, "Run directory")->required();
  command->callback([&] { chosen = [&] { return verify_command(verify_run); }; });

  command = app.add_subcommand("list", "Worlds, scenarios, robots, sensors, methods");
  command->callback([&] { chosen = [] { return list_command(); }; });
}

/// CLI11 would only say that a command is required.
void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (word.starts_with('-') || std::find(known.begin(), known.end(), word) != known.end()) return;
  throw InputError(fmt::format("there is no command '{}' (known: {})", word, fmt::join(known, ", ")));
}

/// What a message quotes from a file may hold line ends and other control characters: they are written out.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n') line += "\\n";
    else if (code < 0x20 || code == 0x7f) line += fmt::format("\\x{:02x}", code);
    else line += c;
  }
  return line;
}

int report(const std::string& what, ExitCode code) {
  fmt::print(stderr, "patrol: {}\n", on_one_line(what));
  return static_cast<int>(code);
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  mju_user_warning = [](const char* text) { fmt::print(stderr, "mujoco: {}\n", text); };  // else a file in the working directory
  CLI::App app("Patrol: a digital twin for inspection robots");
  app.set_version_flag("--version", PATROL_VERSION);
  app.require_subcommand(1);

  std::function<ExitCode()> chosen;
  RunOptions run;
  ScoreOptions score;
  ReplayOptions replay;
  std::filesystem::path verify_run;
  add_commands(app, chosen, run, score, replay, verify_run);

  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return static_cast<int>(chosen());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const InputError& error) {
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::kProgramFailed);
  }
}

}  // namespace patrol::app
