#include "localize/amcl/range_bias_map.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {
namespace {

constexpr double kKernelStd_m = 2.0;   // standard deviation of the Gaussian kernel that averages positions
constexpr double kPriorRanges = 10.0;  // weight of the mean of all positions, in ranges at the position

}  // namespace

RangeBiasMap::RangeBiasMap(const std::vector<slam::MappedRange>& ranges, const std::vector<UwbAnchor>& anchors_in_map,
                           const UwbCalibration& calibration) {
  std::map<int, int> counts;
  for (const slam::MappedRange& range : ranges) {
    const auto anchor = std::ranges::find(anchors_in_map, range.anchor, &UwbAnchor::number);
    if (anchor == anchors_in_map.end()) continue;
    const PredictedRange predicted = predict_uwb_range(*anchor, range.T_map_body, range.p_level_antenna, calibration);
    AnchorBias& bias = anchors_[range.anchor];
    bias.local.push_back({range.T_map_body.position(), range.range_m - predicted.range_m, range.count});
    bias.mean_m += (bias.local.back().bias_m - bias.mean_m) * range.count / (counts[range.anchor] += range.count);
  }
}

double RangeBiasMap::bias_m(int anchor) const {
  const auto found = anchors_.find(anchor);
  return found == anchors_.end() ? 0.0 : found->second.mean_m;
}

double RangeBiasMap::bias_m(int anchor, const Eigen::Vector2d& p_map) const {
  const auto found = anchors_.find(anchor);
  if (found == anchors_.end()) return 0.0;
  double weight = kPriorRanges, sum = kPriorRanges * found->second.mean_m;
  for (const LocalBias& local : found->second.local) {
    const double ratio2 = (local.p_map - p_map).squaredNorm() / (kKernelStd_m * kKernelStd_m);
    const double one = local.count * std::exp(-0.5 * ratio2);
    weight += one;
    sum += one * local.bias_m;
  }
  return sum / weight;
}

}  // namespace patrol::localize
