#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// Access to the commands of the program and to their arguments, for the texts that are generated from them.
namespace patrol::app {

inline std::vector<const CLI::App*> commands_of(const CLI::App& app) { return app.get_subcommands({}); }

/// Name of a command and its aliases.
inline std::vector<std::string> names_of(const CLI::App& command) {
  std::vector<std::string> names = command.get_aliases();
  names.insert(names.begin(), command.get_name());
  return names;
}

inline std::vector<const CLI::Option*> arguments_of(const CLI::App& command, bool are_options) {
  std::vector<const CLI::Option*> arguments = command.get_options({});
  std::erase_if(arguments, [&](const CLI::Option* argument) { return argument->nonpositional() != are_options; });
  return arguments;
}

inline std::vector<const CLI::Option*> options_of(const CLI::App& command) { return arguments_of(command, true); }

inline std::vector<const CLI::Option*> positionals_of(const CLI::App& command) { return arguments_of(command, false); }

inline bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Returns the values of which an argument is one; empty if any are allowed.
inline std::vector<std::string> choices_of(const CLI::Option& argument) {
  const std::string type = argument.get_type_name();  // for example TEXT:{y,z}
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

/// Name of an option with its two hyphens.
inline std::string long_name(const CLI::Option& option) { return "--" + option.get_lnames().front(); }

}  // namespace patrol::app
