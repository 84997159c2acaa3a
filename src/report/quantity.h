#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace patrol::report {

/// Value with a unit that suits its magnitude, for display.
struct Quantity {
  std::string value;
  std::string unit;

  std::string text() const { return value + " " + unit; }
};

inline Quantity length(double length_m) {
  const double size_m = std::abs(length_m);
  if (size_m < 0.01) return {fmt::format("{:.1f}", 1e3 * length_m), "mm"};
  if (size_m < 1.0) return {fmt::format("{:.1f}", 1e2 * length_m), "cm"};
  return {fmt::format("{:.{}f}", length_m, size_m < 100.0 ? 1 : 0), "m"};
}

/// Display unit of a metric, by the unit in its name.
struct Unit {
  double factor = 1.0;
  std::string name;
};

inline Unit unit_of(const std::string& metric) {
  if (metric.ends_with("_m")) return {100.0, "cm"};
  if (metric.ends_with("_deg")) return {1.0, "°"};
  if (metric.ends_with("_s")) return {1.0, "s"};
  return {};
}

inline Quantity angle(double angle_deg) {
  return {fmt::format("{:.{}f}", angle_deg, std::abs(angle_deg) < 10.0 ? 2 : 1), "°"};
}

}  // namespace patrol::report
