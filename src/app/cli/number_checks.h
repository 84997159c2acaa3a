#pragma once

#include <CLI/CLI.hpp>

namespace patrol::app {

/// Checks of the limits of a number, with a short message. CLI11 prints the largest number as the upper limit.
CLI::Validator above_zero();
CLI::Validator not_negative();

/// Adds checks that CLI11 lacks to every option of every command, by the type of its value: integers must be decimal
/// and not negative, numbers within 1e9.
void add_number_checks(CLI::App& app);

}  // namespace patrol::app
