#include "stack/localization/slam_localizer.h"

#include <algorithm>
#include <utility>

namespace patrol::stack {

SlamLocalizer::SlamLocalizer(std::unique_ptr<slam::Mapper> mapper, std::vector<UwbAnchor> anchors_in_map,
                             std::optional<Pose3> T_body_uwb, const Eigen::Matrix3d& map_covariance)
    : mapper_(std::move(mapper)),
      anchors_(std::move(anchors_in_map)),
      T_body_uwb_(std::move(T_body_uwb)),
      map_covariance_(map_covariance) {}

void SlamLocalizer::add(const RangeWithOdometry& range) {
  const auto anchor = std::find_if(anchors_.begin(), anchors_.end(),
                                   [&](const UwbAnchor& known) { return known.number == range.range.anchor; });
  if (anchor == anchors_.end() || !T_body_uwb_) return;
  mapper_->add({.anchor = *anchor,
                .range_m = range.range.range_m,
                .T_odom_body = to_pose2(range.T_odom_body),
                .p_level_antenna = uwb_antenna_in_level(range.T_odom_body.rotation, *T_body_uwb_, range.height_m)});
}

PoseEstimate SlamLocalizer::update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) {
  const auto timer = output.time_stage("slam");
  const slam::SlamUpdate update = mapper_->update(scan, T_odom_body);
  PoseEstimate estimate{scan.stamp, update.T_map_body, update.covariance + map_covariance_};
  output.publish(estimate);
  if (!update.is_keyframe) return estimate;
  if (ParticleSet particles = mapper_->particles(); !particles.T_map_body.empty()) output.publish(std::move(particles));
  return estimate;
}

Pose2 SlamLocalizer::finish_map(const PoseEstimate& /*pose*/) {
  if (!std::exchange(is_mapping_, false)) return {};
  const std::vector<Pose2> before = mapper_->path();
  mapper_->finish();
  return before.empty() ? Pose2{} : mapper_->path().back() * before.back().inverse();
}

}  // namespace patrol::stack
