#include "stack/localization/known_map_localizer.h"

#include <utility>

namespace patrol::stack {

KnownMapLocalizer::KnownMapLocalizer(const localize::MonteCarloSettings& settings, OccupancyGrid map,
                                     const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb,
                                     std::uint64_t seed)
    : map_(std::move(map)), localizer_(settings, map_, anchors_in_map, T_body_uwb, seed) {}

PoseEstimate KnownMapLocalizer::update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) {
  const auto timer = output.time_stage("localization");
  localize::LocalizationUpdate update = localizer_.update(scan, T_odom_body);
  confidence_ = update.confidence;
  output.publish(update.estimate);
  output.publish(update.confidence);
  if (update.particles) output.publish(std::move(*update.particles));
  return update.estimate;
}

}  // namespace patrol::stack
