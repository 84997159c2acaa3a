#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/commands/commands.h"

namespace patrol::app {

/// Options of all commands, and the command to call.
struct Call {
  RunOptions run;
  TraceOptions trace;
  BisectOptions bisect;
  ScoreOptions score;
  LocalizabilityOptions localizability;
  CheckOptions check;
  ReplayOptions replay;
  ReportOptions report;
  VerifyOptions verify;
  FeedOptions feed;
  std::optional<std::string> stack_address;
  SweepOptions sweep;
  MergeOptions merge;
  ErrorBudgetOptions error_budget;
  FaultMatrixOptions fault_matrix;
  SlamOptions slam;
  CalibrateOptions calibrate;
  RealismOptions realism;
  TrainOptions train;
  ImportRobotOptions import_robot;
  ImportSiteOptions import_site;
  GenerateOptions generate;
  SiteOptions site;
  std::string generated_kind;
  std::string imported_kind;
  SolveOptions solve;
  PlanOptions plan;
  StudyOptions study;
  TestOptions test;
  MonitorOptions monitor;
  UploadOptions upload;
  ListOptions list;
  std::string printed_text;
  std::function<ExitCode()> chosen;
};

/// Help texts of options that several commands have.
inline constexpr const char* kSetHelp = "Override a setting, path=value (repeatable)";
inline constexpr const char* kSetAllHelp = "Override a setting in every run, path=value (repeatable)";
inline constexpr const char* kSeedHelp = "Random seed";
inline constexpr const char* kStackHelp =
    "Command of a stack, or unix:PATH or tcp:127.0.0.1:PORT where it connects (default: by the scenario)";
inline constexpr const char* kOutHelp = "Output directory";
inline constexpr const char* kSkipHelp = "Skip unreadable records of a damaged log";
inline constexpr const char* kLogHelp = "Log file, CARMEN text (plain or gzip) or MCAP, or run directory";
inline constexpr const char* kAllHelp = "Print every metric";
inline constexpr const char* kTokenHelp = "File with the access token (default: $PATROL_TOKEN)";

/// Adds the positional argument that names a scenario.
CLI::Option* add_scenario(CLI::App& command, std::filesystem::path& scenario);

/// Adds `--json` to a command that prints a table.
void add_json(CLI::App& command, ResultForm& form);

/// Each of these adds commands with their options to `app`. Parsing stores the options in `call` and chooses the
/// command.
void add_run_commands(CLI::App& app, Call& call);
void add_campaign_commands(CLI::App& app, Call& call);
void add_mapping_commands(CLI::App& app, Call& call);
void add_import_command(CLI::App& app, Call& call);
void add_generate_command(CLI::App& app, Call& call);
void add_site_command(CLI::App& app, Call& call);
void add_program_commands(CLI::App& app, Call& call);

}  // namespace patrol::app
