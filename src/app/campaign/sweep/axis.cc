#include "app/campaign/sweep/axis.h"

#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "core/text.h"

namespace patrol::app {
namespace {

[[noreturn]] void fail(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("--vary {}: {}", text, what));
}

/// Splits a list at separators outside of brackets and quotes.
std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'') quote = c;
    else if (c == '[' || c == '{') ++depth;
    else if (c == ']' || c == '}') --depth;
    if (c == ',' && depth == 0 && quote == 0) values.emplace_back();
    else values.back() += c;
  }
  return values;
}

/// Parses "range:0:1:5" to its numbers; none if `values` begins with another word.
std::optional<std::vector<double>> arguments(const std::string& text, const std::string& values,
                                             const std::string& word, std::size_t count, const std::string& shape) {
  if (!values.starts_with(word + ":")) return std::nullopt;
  std::vector<double> numbers;
  std::size_t begin = word.size() + 1;
  while (begin <= values.size()) {
    const std::size_t end = std::min(values.find(':', begin), values.size());
    double number = 0.0;
    const auto [rest, error] = std::from_chars(values.data() + begin, values.data() + end, number);
    if (error != std::errc() || rest != values.data() + end || !std::isfinite(number)) {
      fail(text, fmt::format("'{}' is not a number: must be {}:{}", values.substr(begin, end - begin), word, shape));
    }
    numbers.push_back(number);
    begin = end + 1;
  }
  if (numbers.size() != count) fail(text, fmt::format("must be {}:{}", word, shape));
  return numbers;
}

std::vector<std::string> spaced(const std::string& text, const std::vector<double>& range, bool in_ratios) {
  const double from = range[0], to = range[1];
  if (range[2] < 2.0 || range[2] > 10000.0 || range[2] != std::floor(range[2]))
    fail(text, "N must be an integer in [2, 10000]");
  if (in_ratios && (from <= 0.0 || to <= 0.0)) fail(text, "both ends must be greater than 0");
  const int count = static_cast<int>(range[2]);
  std::vector<std::string> values;
  for (int i = 0; i < count; ++i) {
    const double fraction = static_cast<double>(i) / (count - 1);
    const double value = in_ratios ? from * std::pow(to / from, fraction) : from + (to - from) * fraction;
    // Twelve digits: 0.3, not 0.30000000000000004.
    values.push_back(fmt::format("{:.12g}", i == 0 ? from : i + 1 == count ? to : value));
  }
  return values;
}

}  // namespace

std::string Axis::sample(std::uint64_t seed) const {
  const RandomStream stream(seed, "sweep/" + path);
  double value = 0.0;
  if (kind == Kind::kUniform) value = first + (second - first) * stream.uniform(0);
  if (kind == Kind::kLogUniform) value = first * std::pow(second / first, stream.uniform(0));
  if (kind == Kind::kNormal) value = first + second * stream.normal(0);
  return fmt::format("{}={}", path, value);
}

Axis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    fail(text, "must be path=a,b,c, e.g. sensors.lidar.range_noise_std_m=0.01,0.03");
  Axis axis;
  axis.path = text.substr(0, equals);
  const std::string values = text.substr(equals + 1);
  if (values.empty()) fail(text, "must have at least one value");

  const auto random = [&](Axis::Kind kind, const std::vector<double>& numbers) {
    axis.kind = kind;
    axis.first = numbers[0], axis.second = numbers[1];
    if (kind == Axis::Kind::kNormal && axis.second < 0.0) fail(text, "the standard deviation must not be negative");
    if (kind != Axis::Kind::kNormal && axis.second < axis.first) fail(text, "HIGH must not be less than LOW");
    if (kind == Axis::Kind::kLogUniform && axis.first <= 0.0) fail(text, "LOW must be greater than 0");
  };
  if (const auto range = arguments(text, values, "range", 3, "FROM:TO:N")) axis.values = spaced(text, *range, false);
  else if (const auto ratios = arguments(text, values, "logrange", 3, "FROM:TO:N"))
    axis.values = spaced(text, *ratios, true);
  else if (const auto limits = arguments(text, values, "uniform", 2, "LOW:HIGH")) random(Axis::Kind::kUniform, *limits);
  else if (const auto logs = arguments(text, values, "loguniform", 2, "LOW:HIGH"))
    random(Axis::Kind::kLogUniform, *logs);
  else if (const auto parameters = arguments(text, values, "normal", 2, "MEAN:STANDARD_DEVIATION"))
    random(Axis::Kind::kNormal, *parameters);
  else axis.values = split_values(values);

  std::set<std::string> seen;
  for (const std::string& value : axis.values) {
    if (value.empty()) fail(text, "empty value");
    if (!seen.insert(value).second) fail(text, fmt::format("duplicate value '{}'", value));
  }
  return axis;
}

std::vector<Variant> cartesian_product(const std::vector<Axis>& axes) {
  std::set<std::string> paths;
  std::vector<Variant> variants(1);
  for (const Axis& axis : axes) {
    if (!paths.insert(axis.path).second) throw InputError(fmt::format("--vary {}: specified twice", axis.path));
    if (axis.is_random()) continue;
    std::vector<Variant> longer;
    for (const Variant& variant : variants) {
      for (const std::string& value : axis.values) {
        longer.push_back(variant);
        longer.back().overrides.push_back(axis.path + "=" + value);
      }
    }
    variants = std::move(longer);
  }
  for (Variant& variant : variants) {
    variant.name = variant.overrides.empty() ? "baseline" : join(variant.overrides, ", ");
  }
  return variants;
}

}  // namespace patrol::app
