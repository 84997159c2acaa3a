#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patrol::app {

/// Texts made from the commands and options of the program, for its package.

/// Completion script of bash: commands, options, and files.
std::string bash_completion(const CLI::App& app);
/// Completion script of zsh, with the description of each command and option.
std::string zsh_completion(const CLI::App& app);
/// Manual page in the format of man(7).
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace patrol::app
