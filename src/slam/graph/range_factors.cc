#include "slam/graph/range_factors.h"

#include <cmath>

namespace patrol::slam {

void RangeFactors::add(int node, const Pose2& T_survey_node, const Pose2& T_node_then,
                       const RangeMeasurement& measurement) {
  const auto predicted_m = [&](const Pose2& T_survey_body) {
    return predict_uwb_range(measurement.anchor, T_survey_body, measurement.p_level_antenna, settings_.calibration)
        .range_m;
  };
  const double range_at_node_m =
      measurement.range_m - predicted_m(T_survey_node * T_node_then) + predicted_m(T_survey_node);
  for (auto range = ranges_.rbegin(); range != ranges_.rend() && range->node == node; ++range) {
    if (range->anchor_in_survey.number != measurement.anchor.number) continue;
    range->range_m += (range_at_node_m - range->range_m) / ++range->count;
    return;
  }
  ranges_.push_back({.node = node,
                     .anchor_in_survey = measurement.anchor,
                     .p_level_antenna = measurement.p_level_antenna,
                     .range_m = range_at_node_m,
                     .count = 1});
}

double RangeFactors::delay_m(int anchor) const {
  const auto delay = delays_m_.find(anchor);
  return delay == delays_m_.end() ? 0.0 : delay->second;
}

double RangeFactors::std_m(const RangeFactor& range) const {
  return std::hypot(settings_.range_std_m / std::sqrt(range.count), settings_.common_std_m);
}

}  // namespace patrol::slam
