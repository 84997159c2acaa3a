#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "app/cli/command_options.h"
#include "app/cli/command_texts.h"
#include "app/cli/reference.h"

namespace patrol::app {
namespace {

void add_monitor(CLI::App& app, Call& call) {
  MonitorOptions& monitor = call.monitor;
  CLI::App* command = app.add_subcommand("monitor", "Run the monitoring server until interrupted");
  command->add_option("--port", monitor.port, "TCP port (0: any free port)")->capture_default_str();
  command->add_option("--host", monitor.host, "Address or host name to listen on (0.0.0.0: all networks)")
      ->capture_default_str();
  command->add_option("--allow-host", monitor.allowed_hosts, "Host name accepted besides the address (repeatable)");
  command->add_option("--data-dir", monitor.data_dir, "Data directory")->capture_default_str();
  command->add_option("--token-file", monitor.token_file,
                      "File with the access token (default: $PATROL_TOKEN, else created in the data directory)");
  command->callback([&] { call.chosen = [&] { return monitor_command(call.monitor); }; });
}

void add_list(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("list", "List scenarios, robots, sensors, methods and metrics");
  command->add_option("section", call.list.section, "Section to print, for example metrics (default: all)");
  add_json(*command, call.list.form);
  command->callback([&] { call.chosen = [&] { return list_command(call.list); }; });
}

/// Texts of `patrol print`, by name.
const std::map<std::string, std::string (*)(const CLI::App&)> kPrintedTexts = {
    {"bash-completion", bash_completion},
    {"zsh-completion", zsh_completion},
    {"man-page", [](const CLI::App& app) { return man_page(app, PATROL_VERSION); }},
    {"reference", [](const CLI::App& app) { return reference_json(app).dump(1) + "\n"; }}};

void add_print(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("print", "Print a text about the program");
  std::vector<std::string> names;
  for (const auto& [name, text] : kPrintedTexts) names.push_back(name);
  command
      ->add_option("text", call.printed_text,
                   "bash-completion, zsh-completion, man-page, or reference: commands, settings, metrics, events and "
                   "topics as JSON")
      ->required()
      ->check(CLI::IsMember(names));
  command->callback([&] {
    call.chosen = [&] {
      std::cout << kPrintedTexts.at(call.printed_text)(app);
      return ExitCode::kDone;
    };
  });
}

}  // namespace

void add_program_commands(CLI::App& app, Call& call) {
  add_monitor(app, call);
  add_list(app, call);
  add_print(app, call);
}

}  // namespace patrol::app
