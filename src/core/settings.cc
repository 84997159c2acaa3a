#include "core/settings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol {
namespace {

[[noreturn]] void fail(const std::string& key, const std::string& value, const Limits& limits) {
  throw InputError(fmt::format("{} = {}: {}", key, value, describe_limits(limits)));
}

template <typename Number>
void check(const std::string& key, Number value, const Limits& limits) {
  if (!allows(limits, static_cast<double>(value))) fail(key, fmt::format("{}", value), limits);
}

}  // namespace

Limits any() { return {}; }
Limits at_least(double min) { return {.min = min, .allowed = {}}; }
Limits between(double min, double max) { return {.min = min, .max = max, .allowed = {}}; }
Limits one_of(std::vector<std::string> allowed) { return {.allowed = std::move(allowed)}; }

std::string describe_limits(const Limits& limits) {
  if (!limits.allowed.empty()) return "must be one of " + join(limits.allowed, ", ");
  const bool has_min = std::isfinite(limits.min), has_max = std::isfinite(limits.max);
  if (has_min && has_max) return fmt::format("must be in [{}, {}]", limits.min, limits.max);
  if (has_min) return fmt::format("must be at least {}", limits.min);
  if (has_max) return fmt::format("must be at most {}", limits.max);
  return "must be finite";
}

bool allows(const Limits& limits, double value) {
  return std::isfinite(value) && value >= limits.min && value <= limits.max;
}

bool allows(const Limits& limits, const std::string& value) {
  return limits.allowed.empty() || std::ranges::find(limits.allowed, value) != limits.allowed.end();
}

void Validator::operator()(const char* name, const int& value, const Limits& limits) const {
  check(key(name), value, limits);
}
void Validator::operator()(const char* name, const std::uint64_t& value, const Limits& limits) const {
  check(key(name), value, limits);
}
void Validator::operator()(const char* name, const double& value, const Limits& limits) const {
  check(key(name), value, limits);
}
void Validator::operator()(const char* name, const std::string& value, const Limits& limits) const {
  if (!allows(limits, value)) fail(key(name), value, limits);
}

std::string Validator::key(const char* name) const { return prefix_.empty() ? name : prefix_ + "." + name; }

}  // namespace patrol
