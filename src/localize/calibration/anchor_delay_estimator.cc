#include "localize/calibration/anchor_delay_estimator.h"

#include <cmath>

namespace patrol::localize {
namespace {

constexpr Eigen::Index kNumMapParameters = 3;

Eigen::VectorXd prior_std(const AnchorDelayEstimatorSettings& settings, std::size_t num_anchors) {
  Eigen::VectorXd std =
      Eigen::VectorXd::Constant(kNumMapParameters + static_cast<Eigen::Index>(num_anchors), settings.prior_delay_std_m);
  std.head<kNumMapParameters>() << settings.prior_map_std_m, settings.prior_map_std_m, settings.prior_map_std_rad;
  return std;
}

}  // namespace

AnchorDelayEstimator::AnchorDelayEstimator(const AnchorDelayEstimatorSettings& settings,
                                           const std::vector<UwbAnchor>& anchors_in_map,
                                           const UwbCalibration& calibration)
    : settings_(settings),
      calibration_(calibration),
      filter_(prior_std(settings, anchors_in_map.size()), {.group_s = 5.0}) {
  Eigen::Index parameter = kNumMapParameters;
  for (const UwbAnchor& anchor : anchors_in_map)
    anchors_.emplace(anchor.number, Anchor{.anchor = anchor, .parameter = parameter++});
}

void AnchorDelayEstimator::add(const LocatedRange& located) {
  const auto found = anchors_.find(located.range.anchor);
  if (found == anchors_.end() || !std::isfinite(located.range.range_m)) return;
  const PredictedRange predicted =
      predict_uwb_range(found->second.anchor, located.pose.T_map_body, located.p_level_antenna, calibration_);
  LinearMeasurement measurement{
      .stamp = located.pose.stamp,
      .J = Eigen::MatrixXd::Zero(1, kNumMapParameters + static_cast<Eigen::Index>(anchors_.size())),
      .r = Eigen::VectorXd::Constant(1, located.range.range_m - predicted.range_m),
      .W = {}};
  // The pose of map in the survey moves the robot and turns it about the origin of map.
  const Eigen::Vector3d& H = predicted.H_pose;
  const Pose2& T_map_body = located.pose.T_map_body;
  measurement.J.leftCols<kNumMapParameters>() << H.x(), H.y(), H.z() + H.y() * T_map_body.x - H.x() * T_map_body.y;
  measurement.J(0, found->second.parameter) = 1.0;
  const double variance = settings_.range_std_m * settings_.range_std_m + H.dot(located.pose.covariance * H);
  measurement.W = Eigen::MatrixXd::Constant(1, 1, 1.0 / variance);
  if (filter_.distance(measurement) > settings_.outlier_sigma * settings_.outlier_sigma) return;
  filter_.add(measurement);
  ++found->second.num_ranges;
}

std::vector<CalibrationValue> AnchorDelayEstimator::delays() const {
  const LinearEstimate estimate = filter_.estimate();
  std::vector<CalibrationValue> values;
  for (const auto& [number, anchor] : anchors_) {
    if (anchor.num_ranges == 0) continue;
    values.push_back({.name = anchor_delay_name(number),
                      .value = estimate.value[anchor.parameter],
                      .std = std::hypot(estimate.std(anchor.parameter), settings_.bias_std_m)});
  }
  return values;
}

}  // namespace patrol::localize
