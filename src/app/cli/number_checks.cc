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

}  // namespace

void add_number_checks(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      if (type == "UINT") option->check(CLI::Validator(refuse_bad_seed, "", "seed"));
      if (type == "FLOAT") option->check(CLI::Validator(refuse_bad_number, "", "number"));
    }
  }
}

}  // namespace patrol::app
