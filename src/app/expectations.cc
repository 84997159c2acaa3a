#include "app/expectations.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// The number at a dotted path; true and false count as 1 and 0.
std::optional<double> number_at(const nlohmann::ordered_json& metrics, const std::string& path) {
  const nlohmann::ordered_json* node = &metrics;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (!node->is_object() || !node->contains(key)) return std::nullopt;
    node = &node->at(key);
    begin = end + 1;
  }
  if (node->is_boolean()) return node->get<bool>() ? 1.0 : 0.0;
  if (node->is_number()) return node->get<double>();
  return std::nullopt;
}

std::string rule_of(const io::Expectation& expectation) {
  if (expectation.is_boolean) return expectation.min > 0.5 ? "true" : "false";
  const bool has_min = std::isfinite(expectation.min), has_max = std::isfinite(expectation.max);
  if (has_min && has_max && expectation.min == expectation.max) return fmt::format("= {}", expectation.min);
  if (has_min && has_max) return fmt::format("{} ... {}", expectation.min, expectation.max);
  return has_min ? fmt::format(">= {}", expectation.min) : fmt::format("<= {}", expectation.max);
}

}  // namespace

std::vector<CheckedExpectation> check_expectations(const io::Expectations& expectations, const nlohmann::ordered_json& metrics) {
  std::vector<CheckedExpectation> checks;
  for (const auto& [metric, expectation] : expectations) {
    CheckedExpectation check{.metric = metric, .wanted = rule_of(expectation), .got = "not measured"};
    if (const std::optional<double> value = number_at(metrics, metric)) {
      check.is_measured = true;
      check.got = expectation.is_boolean ? (*value > 0.5 ? "true" : "false") : fmt::format("{:.4g}", *value);
      check.is_met = *value >= expectation.min && *value <= expectation.max;
    }
    checks.push_back(check);
  }
  return checks;
}

}  // namespace patrol::app
