#include "app/cli/command_options.h"

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"

namespace patrol::app {

CLI::Option* add_scenario(CLI::App& command, std::filesystem::path& scenario) {
  return command.add_option("scenario", scenario, "Scenario file (YAML), or WORLD/NAME, for example street/patrol")
      ->required()
      ->transform([](const std::string& name) { return find_scenario(name).string(); });
}

void add_json(CLI::App& command, ResultForm& form) {
  command.add_flag_callback(
      "--json", [&form] { form = ResultForm::kJson; }, "Print the results as JSON");
}

}  // namespace patrol::app
