#include "app/campaign/test/limit_rules.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patrol::app {
namespace {

bool matches_pattern(std::string_view pattern, std::string_view metric) {
  while (true) {
    const std::string_view wanted = pattern.substr(0, pattern.find('.')), name = metric.substr(0, metric.find('.'));
    if (wanted != "*" && wanted != name) return false;
    const bool is_last = wanted.size() == pattern.size();
    if (is_last != (name.size() == metric.size())) return false;
    if (is_last) return true;
    pattern.remove_prefix(wanted.size() + 1);
    metric.remove_prefix(name.size() + 1);
  }
}

/// Rounds to a number of significant digits, towards minus or plus infinity.
double rounded(double value, int digits, double (*round)(double)) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const int exponent = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double scale = std::pow(10.0, exponent), scaled = value * scale;
  const double nearest = std::round(scaled);
  const double whole = std::abs(scaled - nearest) < 1e-9 * std::abs(scaled) ? nearest : round(scaled);
  return std::stod(fmt::format("{:.{}e}", whole / scale, digits));
}

double floor_of(double value) { return std::floor(value); }
double ceil_of(double value) { return std::ceil(value); }

io::Expectation error_limits(double lowest, double highest) {
  io::Expectation limits;
  if (lowest != 0.0) limits.min = rounded(lowest < 0.0 ? 2.0 * lowest : lowest / 3.0, 2, floor_of);
  limits.max = highest < 0.0 ? rounded(highest / 3.0, 2, ceil_of) : rounded(2.0 * highest, 2, floor_of);
  return limits;
}

}  // namespace

std::size_t rule_index(std::string_view metric) {
  const auto found = std::find_if(kMetricRules.begin(), kMetricRules.end(),
                                  [&](const MetricRule& rule) { return matches_pattern(rule.pattern, metric); });
  return static_cast<std::size_t>(found - kMetricRules.begin());
}

LimitRule rule_of(std::string_view metric) {
  const std::size_t index = rule_index(metric);
  return index < kMetricRules.size() ? kMetricRules[index].rule : LimitRule::kError;
}

bool is_standard(std::string_view metric) {
  const std::size_t index = rule_index(metric);
  return index < kMetricRules.size() && kMetricRules[index].is_standard;
}

std::optional<io::Expectation> limits_of(LimitRule rule, const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double lowest = *low, highest = *high;
  io::Expectation limits;
  switch (rule) {
    case LimitRule::kError:
      return error_limits(lowest, highest);
    case LimitRule::kExtent:
      return io::Expectation{.min = rounded(0.9 * lowest, 3, floor_of), .max = rounded(1.1 * highest, 3, ceil_of)};
    case LimitRule::kFloor:
      limits.min = rounded(lowest < 0.0 ? lowest / 0.9 : 0.9 * lowest, 2, floor_of);
      return limits;
    case LimitRule::kMaxCount:
      limits.max = highest;
      return limits;
    case LimitRule::kMinCount:
      if (lowest == 0.0) return std::nullopt;
      limits.min = lowest;
      return limits;
    case LimitRule::kTruth:
      if (lowest != highest) return std::nullopt;
      return io::Expectation{.min = lowest, .max = lowest, .is_boolean = true};
  }
  return std::nullopt;
}

io::Expectation narrower(const io::Expectation& a, const io::Expectation& b) {
  return {.min = std::max(a.min, b.min), .max = std::min(a.max, b.max), .is_boolean = a.is_boolean};
}

bool is_wider(const io::Expectation& proposed, const io::Expectation& present) {
  return proposed.min < present.min || proposed.max > present.max;
}

std::string to_yaml(const io::Expectation& expectation) {
  if (expectation.is_boolean) return expectation.min > 0.5 ? "true" : "false";
  const bool has_min = std::isfinite(expectation.min), has_max = std::isfinite(expectation.max);
  if (has_min && has_max && expectation.min == expectation.max) return fmt::format("{}", expectation.min);
  if (has_min && has_max) return fmt::format("{{min: {}, max: {}}}", expectation.min, expectation.max);
  return has_min ? fmt::format("{{min: {}}}", expectation.min) : fmt::format("{{max: {}}}", expectation.max);
}

}  // namespace patrol::app
