#include "stack/localization/map_then_localize.h"

#include <utility>

namespace patrol::stack {

MapThenLocalize::MapThenLocalize(std::unique_ptr<Localizer> slam, LocalizerFactory make_on_map)
    : current_(std::move(slam)), make_on_map_(std::move(make_on_map)) {}

void MapThenLocalize::add(const RangeWithOdometry& range) {
  RangeWithOdometry corrected = range;
  if (const auto delay = range_delays_m_.find(range.range.anchor); delay != range_delays_m_.end())
    corrected.range.range_m -= delay->second;
  current_->add(corrected);
}

Pose2 MapThenLocalize::finish_map(const PoseEstimate& pose) {
  if (!current_->is_mapping()) return {};
  const Pose2 T_map_old = current_->finish_map(pose);
  path_of_mapping_ = current_->path();
  range_delays_m_ = current_->range_delays_m();
  current_ = make_on_map_(current_->map());
  if (anchors_in_map_) current_->set_anchors(*anchors_in_map_);
  current_->set_initial_pose(T_map_old * pose.T_map_body, pose.covariance);
  return T_map_old;
}

void MapThenLocalize::set_anchors(const std::vector<UwbAnchor>& anchors_in_map) {
  anchors_in_map_ = anchors_in_map;
  current_->set_anchors(anchors_in_map);
}

}  // namespace patrol::stack
