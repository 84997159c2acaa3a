#include "app/cli/command_texts.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "app/cli/command_arguments.h"
#include "core/text.h"

namespace patrol::app {
namespace {

/// Returns the text with a backslash in front of each of the characters.
std::string escaped(const std::string& text, std::string_view characters) {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// Content of a string in single quotes of a shell.
std::string in_quotes(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result;
}

/// Text for man(7), in which a hyphen would become a typographic one.
std::string to_roff(const std::string& text) {
  const std::string result = escaped(text, "\\-");
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

/// Cases of bash for the word after an option, or after the command, that is one of several values.
std::string bash_choices(const CLI::App& command, const std::string& name) {
  std::string cases;
  const auto add = [&cases, &name](const std::string& previous, const CLI::Option& argument) {
    const std::vector<std::string> choices = choices_of(argument);
    if (!choices.empty()) cases += fmt::format("    '{} {}') choices='{}' ;;\n", name, previous, join(choices, " "));
  };
  const std::vector<const CLI::Option*> positionals = positionals_of(command);
  if (!positionals.empty()) add(name, *positionals.front());
  for (const CLI::Option* option : options_of(command)) add(long_name(*option), *option);
  return cases;
}

/// Value of an argument in a specification of zsh.
std::string zsh_value(const CLI::Option& argument) {
  const std::vector<std::string> choices = choices_of(argument);
  return choices.empty() ? ":value:_files" : fmt::format(":value:({})", join(choices, " "));
}

/// Positional arguments of a command in a specification of zsh.
std::string zsh_positionals(const CLI::App& command) {
  const std::vector<const CLI::Option*> positionals = positionals_of(command);
  const bool has_choices = !positionals.empty() && !choices_of(*positionals.front()).empty();
  return has_choices ? fmt::format("'1{}' '*:file:_files'", zsh_value(*positionals.front())) : "'*:file:_files'";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string cases, choices;
  for (const CLI::App* command : commands_of(app)) {
    const std::vector<std::string> all = names_of(*command);
    names.insert(names.end(), all.begin(), all.end());
    std::vector<std::string> options;
    for (const CLI::Option* option : options_of(*command)) options.push_back(long_name(*option));
    cases += fmt::format("    {}) options='{}' ;;\n", join(all, "|"), join(options, " "));
    for (const std::string& name : all) choices += bash_choices(*command, name);
  }
  return fmt::format(
      "# Completion of patrol for bash.\n"
      "_patrol() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} options= choices=\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- \"$word\")\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  case \"${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD-1]}}\" in\n{}  esac\n"
      "  if [[ -n $choices && ( $COMP_CWORD -gt 2 || $word != -* ) ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$choices\" -- \"$word\")\n"
      "  elif [[ $word == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
      "  else\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
      "  fi\n"
      "}}\n"
      "complete -o filenames -F _patrol patrol\n",
      join(names, " "), cases, choices);
}

std::string zsh_completion(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : commands_of(app)) {
    const std::vector<std::string> all = names_of(*command);
    for (const std::string& name : all)
      names += fmt::format("    '{}:{}'\n", name, in_quotes(escaped(command->get_description(), ":")));
    cases += fmt::format("    {}) _arguments {}", join(all, "|"), zsh_positionals(*command));
    for (const CLI::Option* option : options_of(*command)) {
      cases += fmt::format(" \\\n      '*{}[{}]{}'", long_name(*option),
                           in_quotes(escaped(option->get_description(), "[]:")),
                           takes_value(*option) ? zsh_value(*option) : "");
    }
    cases += " ;;\n";
  }
  return fmt::format(
      "#compdef patrol\n"
      "# Completion of patrol for zsh.\n"
      "_patrol() {{\n"
      "  local -a commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe 'command' commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n{}  esac\n"
      "}}\n"
      "_patrol \"$@\"\n",
      names, cases);
}

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string text = fmt::format(
      ".TH PATROL 1 \"\" \"Patrol {}\" \"User commands\"\n.SH NAME\npatrol \\- digital twin for inspection robots\n"
      ".SH SYNOPSIS\n.B patrol\n.I COMMAND\n[\\fIoptions\\fR]\n.ad l\n.SH COMMANDS\n",
      to_roff(version));
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format(".SS patrol {}", to_roff(command->get_name()));
    for (const CLI::Option* positional : positionals_of(*command)) {
      const std::string name = to_roff(upper(positional->get_name()));
      text += positional->get_required() ? " " + name : fmt::format(" [{}]", name);
    }
    const std::string aliases = join(command->get_aliases(), ", ");
    text += fmt::format("\n{}.{}\n", to_roff(command->get_description()),
                        aliases.empty() ? "" : fmt::format(" Alias: {}.", to_roff(aliases)));
    for (const CLI::Option* positional : positionals_of(*command)) {
      text += fmt::format(".TP\n\\fI{}\\fR\n{}\n", to_roff(upper(positional->get_name())),
                          to_roff(positional->get_description()));
    }
    for (const CLI::Option* option : options_of(*command)) {
      const std::string standard = option->get_default_str();
      text += fmt::format(".TP\n\\fB{}\\fR{}\n{}{}\n", to_roff(long_name(*option)),
                          takes_value(*option) ? " \\fIVALUE\\fR" : "", to_roff(option->get_description()),
                          standard.empty() ? "" : fmt::format(" (default: {})", to_roff(standard)));
    }
  }
  text +=
      ".SH EXIT STATUS\n0: every expectation met; 1: an expectation missed; 2: invalid input or command line; 3: the "
      "program or the simulation failed; 4: time limit; 5: nothing executed.\n"
      ".SH ENVIRONMENT\n.TP\n\\fBPATROL_DATA\\fR\nFolder that contains the folders worlds and models.\n"
      ".TP\n\\fBPATROL_THREADS\\fR\nThreads of a run, 1 or 2.\n"
      ".TP\n\\fBPATROL_TOKEN\\fR\nAccess token of the monitoring server.\n";
  return text;
}

}  // namespace patrol::app
