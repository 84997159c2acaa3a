#include "app/check/figure.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "report/quantity.h"

namespace patrol::app {
namespace {

constexpr std::array<std::string_view, 4> kUnits = {"_mps", "_deg", "_m", "_s"};

std::string text_of(const std::string& name, double value) {
  if (name.ends_with("_mps")) return fmt::format("{:.2f} m/s", value);
  if (name.ends_with("_m")) return report::length(value).text();
  if (name.ends_with("_deg")) return fmt::format("{:.2f}°", value);
  if (name.ends_with("_s")) return fmt::format("{:.2f} s", value);
  if (name.ends_with("_ratio") || name == "friction") return fmt::format("{:.3f}", value);
  return fmt::format("{:g}", value);
}

}  // namespace

std::string label_of(const Figure& figure) {
  std::string label = figure.name;
  const auto unit = std::ranges::find_if(kUnits, [&](std::string_view each) { return label.ends_with(each); });
  if (unit != kUnits.end()) label.resize(label.size() - unit->size());
  std::ranges::replace(label, '_', ' ');
  return label;
}

std::string value_text(const Figure& figure) { return text_of(figure.name, figure.value); }

std::string limit_text(const Figure& figure) {
  const auto text = [&](double limit) { return text_of(figure.name, limit); };
  if (figure.min && figure.max) return fmt::format("{} to {}", text(*figure.min), text(*figure.max));
  if (figure.max) return "at most " + text(*figure.max);
  return figure.min ? "at least " + text(*figure.min) : "";
}

}  // namespace patrol::app
