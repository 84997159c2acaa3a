#include "app/cli/number_checks.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// Accepts decimal digits only. CLI11 converts -1 to 2^64 - 1, and 010 to 8.
std::string refuse_bad_seed(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_octal = text.size() > 1 && text.front() == '0';
  if (error == std::errc() && end == text.data() + text.size() && !is_octal) return "";
  return fmt::format("{}: must be an integer in [0, {}]", text, std::numeric_limits<std::uint64_t>::max());
}

/// Rejects numbers beyond all times, lengths and speeds in use. CLI11 converts 1e400 to infinity.
std::string refuse_bad_number(const std::string& text) {
  constexpr double kMaxNumber = 1e9;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::abs(value) <= kMaxNumber) return "";
  return fmt::format("{}: must be a number in [-1e9, 1e9]", text);
}

/// Returns a check of numbers; those that are no numbers have their own.
CLI::Validator limit_check(bool (*allows)(double), const std::string& name, const std::string& rule) {
  const auto refuse = [allows, rule](const std::string& text) {
    const bool is_allowed = !refuse_bad_number(text).empty() || allows(std::strtod(text.c_str(), nullptr));
    return is_allowed ? std::string() : fmt::format("{}: {}", text, rule);
  };
  return {refuse, name, name};
}

}  // namespace

CLI::Validator above_zero() {
  return limit_check([](double value) { return value > 0.0; }, "POSITIVE", "must be above 0");
}

CLI::Validator not_negative() {
  return limit_check([](double value) { return value >= 0.0; }, "NONNEGATIVE", "must be at least 0");
}

void add_number_checks(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      // A further check appends its name to the type.
      if (type.starts_with("UINT")) option->check(CLI::Validator(refuse_bad_seed, "", "seed"));
      if (type.starts_with("FLOAT")) option->check(CLI::Validator(refuse_bad_number, "", "number"));
    }
  }
}

}  // namespace patrol::app
