#include "slam/graph/position_factors.h"

#include <algorithm>
#include <cmath>

namespace patrol::slam {

void PositionFactors::add(int node, const Pose2& T_node_then, const PositionMeasurement& measurement) {
  if (!settings_.enabled || (!positions_.empty() && positions_.back().node >= node)) return;
  const double correlated_s = 2.0 * measurement.correlation_time_s;
  const double interval_s = last_ ? to_seconds(measurement.stamp - *last_) : correlated_s;
  if (interval_s < settings_.min_interval_s && last_) return;
  last_ = measurement.stamp;
  const double inflation = interval_s > 0.0 ? std::sqrt(std::max(1.0, correlated_s / interval_s)) : 1.0;
  positions_.push_back({.node = node,
                        .p_node_antenna = T_node_then * measurement.p_level_antenna,
                        .p_survey_antenna = measurement.p_survey_antenna,
                        .std_m = inflation * measurement.std_m});
}

}  // namespace patrol::slam
