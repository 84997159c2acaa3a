#include "app/scoring/metric_lines.h"

#include <fmt/format.h>

namespace patrol::app {
namespace {

std::string shown(const io::Metrics& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void add(const std::string& path, const io::Metrics& value, std::vector<MetricLine>& lines) {
  if (value.is_object()) {
    for (const auto& [key, child] : value.items())
      add(path.empty() ? key : fmt::format("{}.{}", path, key), child, lines);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_number()) continue;
      io::Metrics entry = value[i];
      const bool is_named = entry.is_object() && entry.contains("name");
      const std::string name = is_named ? entry.at("name").get<std::string>() : fmt::format("{}", i);
      if (is_named) entry.erase("name");
      add(fmt::format("{}.{}", path, name), entry, lines);
    }
  } else {
    lines.push_back({path, shown(value)});
  }
}

}  // namespace

std::vector<MetricLine> metric_lines(const io::Metrics& metrics) {
  std::vector<MetricLine> lines;
  add("", metrics, lines);
  return lines;
}

}  // namespace patrol::app
