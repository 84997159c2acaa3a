#include "stack/localization/known_map_localizer.h"

#include <utility>

namespace patrol::stack {
namespace {

/// Returns the anchors with heights relative to the body's origin, as Monte Carlo localization expects them.
std::vector<UwbAnchor> anchors_above_body(std::vector<UwbAnchor> anchors, double height_above_ground_m) {
  for (UwbAnchor& anchor : anchors) anchor.p_m.z() -= height_above_ground_m;
  return anchors;
}

}  // namespace

KnownMapLocalizer::KnownMapLocalizer(const localize::MonteCarloSettings& settings, OccupancyGrid map,
                                     const std::vector<UwbAnchor>& anchors_in_map, double height_above_ground_m,
                                     const Pose3& T_body_uwb, const Eigen::Matrix3d& map_covariance, std::uint64_t seed,
                                     const UwbCalibration& calibration)
    : map_(std::move(map)),
      height_above_ground_m_(height_above_ground_m),
      map_covariance_(map_covariance),
      localizer_(settings, map_, anchors_above_body(anchors_in_map, height_above_ground_m), T_body_uwb, seed,
                 calibration) {}

void KnownMapLocalizer::set_anchors(const std::vector<UwbAnchor>& anchors_in_map) {
  localizer_.set_anchors(anchors_above_body(anchors_in_map, height_above_ground_m_));
}

PoseEstimate KnownMapLocalizer::update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) {
  const auto timer = output.time_stage("localization");
  localize::LocalizationUpdate update = localizer_.update(scan, T_odom_body);
  update.estimate.covariance += map_covariance_;
  confidence_ = update.confidence;
  output.publish(update.estimate);
  output.publish(update.confidence);
  if (update.particles) output.publish(std::move(*update.particles));
  return update.estimate;
}

}  // namespace patrol::stack
