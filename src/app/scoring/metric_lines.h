#pragma once

#include <string>
#include <vector>

#include "io/metrics_json.h"

namespace patrol::app {

/// One figure of metrics.json as it is read by people.
struct MetricLine {
  std::string path;  ///< "pose.ate_rmse_m", "stations.home.map_error_m"
  std::string text;  ///< "0.0712", "yes", "-" for one that could not be computed
};

/// Every figure, in the order of the file; lists of plain numbers are left out: their mean, deviation and maximum stand beside them.
std::vector<MetricLine> metric_lines(const io::Metrics& metrics);

}  // namespace patrol::app
