#include "app/scoring/expectations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace patrol::app {
namespace {

std::string describe_limits(const io::Expectation& expectation) {
  if (expectation.is_boolean) return expectation.min > 0.5 ? "true" : "false";
  const bool has_min = std::isfinite(expectation.min), has_max = std::isfinite(expectation.max);
  if (has_min && has_max && expectation.min == expectation.max) return fmt::format("= {}", expectation.min);
  if (has_min && has_max) return fmt::format("{} ... {}", expectation.min, expectation.max);
  return has_min ? fmt::format(">= {}", expectation.min) : fmt::format("<= {}", expectation.max);
}

constexpr double kMinMapCoverage = 0.5;

/// Adds the coverage that a bound of the map's error presumes.
io::Expectations with_map_coverage(io::Expectations expectations) {
  const auto is_map_error = [](const auto& entry) { return entry.first.starts_with("map.nearest_"); };
  if (std::ranges::any_of(expectations, is_map_error))
    expectations.try_emplace("map.coverage", io::Expectation{.min = kMinMapCoverage});
  return expectations;
}

}  // namespace

std::vector<CheckedExpectation> check_expectations(const io::Expectations& expectations, const io::Metrics& metrics) {
  std::vector<CheckedExpectation> checks;
  for (const auto& [metric, expectation] : with_map_coverage(expectations)) {
    CheckedExpectation check{.metric = metric, .wanted = describe_limits(expectation), .got = "not measured"};
    if (const std::optional<double> value = io::metric_at(metrics, metric)) {
      check.is_measured = true;
      check.got = expectation.is_boolean ? (*value > 0.5 ? "true" : "false") : fmt::format("{:.4g}", *value);
      check.is_met = *value >= expectation.min && *value <= expectation.max;
    }
    checks.push_back(check);
  }
  return checks;
}

bool all_met(const std::vector<CheckedExpectation>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const CheckedExpectation& check) { return check.is_met; });
}

}  // namespace patrol::app
