#pragma once

#include <string>
#include <vector>

#include "io/json/metrics_json.h"

namespace patrol::app {

/// Metric of metrics.json as text.
struct MetricLine {
  std::string path;  ///< "pose.ate_rmse_m", "stations.home.map_error_m"
  std::string text;  ///< "0.0712", "yes", "-" for null
};

/// All metrics in the order of the file, without lists of plain numbers: their mean, deviation and maximum are separate
/// metrics.
std::vector<MetricLine> metric_lines(const io::Metrics& metrics);

}  // namespace patrol::app
