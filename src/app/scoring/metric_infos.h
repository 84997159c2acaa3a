#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patrol::app {

/// Documentation of one metric.
struct MetricInfo {
  /// path as in `expect`; `*` stands for parts that depend on the run, such as the name of a station
  std::string path;
  std::string summary;  ///< meaning: a noun phrase, or a clause with "whether"

  /// Whether the values are true and false.
  bool is_boolean() const { return summary.starts_with("whether "); }
};

/// Returns whether `path` has the form of `pattern`, in which `*` stands for at least one character.
bool matches_metric(std::string_view pattern, const std::string& path);

/// Documentation of all metrics, in the order of metrics.json.
std::vector<MetricInfo> metric_infos();

/// Entry of the metric at `path`; nullopt if there is none.
std::optional<MetricInfo> find_metric_info(const std::string& path);

/// Throws InputError if there is no metric at `path`, with the nearest one. `location`: start of the message.
void check_metric(const std::string& location, const std::string& path);

}  // namespace patrol::app
