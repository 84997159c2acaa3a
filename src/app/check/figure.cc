#include "app/check/figure.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "report/quantity.h"

namespace patrol::app {
namespace {

constexpr std::array<std::string_view, 4> kUnits = {"_mps", "_deg", "_m", "_s"};

/// `more_digits`: number of digits in addition to the usual ones.
std::string text_of(const std::string& name, double value, int more_digits) {
  if (name.ends_with("_mps")) return fmt::format("{:.{}f} m/s", value, 2 + more_digits);
  if (name.ends_with("_m") && more_digits == 0) return report::length(value).text();
  if (name.ends_with("_m")) return fmt::format("{:.{}f} m", value, 3 + more_digits);
  if (name.ends_with("_deg")) return fmt::format("{:.{}f}°", value, 2 + more_digits);
  if (name.ends_with("_s")) return fmt::format("{:.{}f} s", value, 2 + more_digits);
  if (name.ends_with("_ratio") || name == "friction") return fmt::format("{:.{}f}", value, 3 + more_digits);
  return fmt::format("{:.{}g}", value, 6 + more_digits);
}

/// Returns the number of digits, in addition to the usual ones, that tell a value from the limit that it does not meet.
int more_digits_of(const Figure& figure) {
  constexpr int kMaxDigits = 6;
  if (figure.is_met()) return 0;
  const double limit = figure.min && !(figure.value >= *figure.min) ? *figure.min : *figure.max;
  int digits = 0;
  while (digits < kMaxDigits && text_of(figure.name, figure.value, digits) == text_of(figure.name, limit, digits))
    ++digits;
  return digits;
}

}  // namespace

std::string label_of(const Figure& figure) {
  std::string label = figure.name;
  const auto unit = std::ranges::find_if(kUnits, [&](std::string_view each) { return label.ends_with(each); });
  if (unit != kUnits.end()) label.resize(label.size() - unit->size());
  std::ranges::replace(label, '_', ' ');
  return label;
}

std::string value_text(const Figure& figure) { return text_of(figure.name, figure.value, more_digits_of(figure)); }

std::string limit_text(const Figure& figure) {
  const auto text = [&](double limit) { return text_of(figure.name, limit, more_digits_of(figure)); };
  if (figure.min && figure.max) return fmt::format("{} to {}", text(*figure.min), text(*figure.max));
  if (figure.max) return "at most " + text(*figure.max);
  return figure.min ? "at least " + text(*figure.min) : "";
}

}  // namespace patrol::app
