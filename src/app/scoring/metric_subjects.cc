#include "app/scoring/metric_subjects.h"

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scoring/metric_infos.h"
#include "core/calibration/calibration_estimate.h"
#include "core/error.h"
#include "core/text.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

/// Part of a metric's path that its documentation leaves open: "box" of "stations.box.reached" for
/// "stations.*.reached".
std::string open_part(const std::string& metric, const std::string& pattern) {
  const std::size_t begin = pattern.find('*'), num_after = pattern.size() - begin - 1;
  return metric.substr(begin, metric.size() - begin - num_after);
}

void check_name(const std::string& location, const char* subject, const std::string& name,
                const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) != known.end()) return;
  const std::string nearest = io::closest_match(name, known);
  throw InputError(fmt::format("{}unknown {} {}{}: must be one of {}", location, subject, name,
                               nearest.empty() ? "" : "; did you mean " + nearest + "?", join(known, ", ")));
}

/// Names of the calibration parameters, with those of the anchors.
std::vector<std::string> parameters_of(const Route& route) {
  std::vector<std::string> names = names_of(kCalibrationParameters);
  for (const UwbAnchor& anchor : route.anchors) names.push_back(anchor_delay_name(anchor.number));
  return names;
}

/// Returns whether `text` is an index into a list.
bool is_index(const std::string& text, std::size_t size) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc() && end == text.data() + text.size() && index < size;
}

}  // namespace

MetricSubjects::MetricSubjects(const Scenario& scenario, std::filesystem::path file)
    : scenario_(scenario), file_(std::move(file)) {}

void MetricSubjects::check(const std::string& location, const std::string& metric) {
  const std::string pattern = find_metric_info(metric).value().path;
  const bool is_of_station = pattern.starts_with("stations.*"), is_of_parameter = pattern.starts_with("calibration.*");
  if (!is_of_station && !is_of_parameter) return;
  if (!route_) route_ = load_route(scenario_, find_data_root(file_));
  const std::string name = open_part(metric, pattern);
  if (is_of_parameter) check_name(location, "parameter", name, parameters_of(*route_));
  else if (!is_index(name, route_->stations.size())) check_name(location, "station", name, route_->station_names());
}

}  // namespace patrol::app
