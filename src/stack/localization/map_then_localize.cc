#include "stack/localization/map_then_localize.h"

#include <utility>

namespace patrol::stack {

MapThenLocalize::MapThenLocalize(std::unique_ptr<Localizer> slam, std::vector<UwbAnchor> anchors_in_map,
                                 LocalizerFactory make_on_map, UwbCalibration calibration)
    : current_(std::move(slam)),
      make_on_map_(std::move(make_on_map)),
      calibration_(std::move(calibration)),
      anchors_in_map_(std::move(anchors_in_map)) {}

void MapThenLocalize::add(const RangeWithOdometry& range) {
  RangeWithOdometry corrected = range;
  const int anchor = range.range.anchor;
  corrected.range.range_m -= p_map_body_ ? range_biases_.bias_m(anchor, *p_map_body_) : range_biases_.bias_m(anchor);
  current_->add(corrected);
}

PoseEstimate MapThenLocalize::update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) {
  const PoseEstimate estimate = current_->update(scan, T_odom_body, output);
  p_map_body_ = current_->has_pose() ? std::optional(estimate.T_map_body.position()) : std::nullopt;
  return estimate;
}

Pose2 MapThenLocalize::finish_map(const PoseEstimate& pose) {
  if (!current_->is_mapping()) return {};
  const Pose2 T_map_old = current_->finish_map(pose);
  path_of_mapping_ = current_->path();
  mapped_ranges_ = current_->mapped_ranges();
  current_ = make_on_map_(current_->map());
  set_anchors(anchors_in_map_);
  current_->set_initial_pose(T_map_old * pose.T_map_body, pose.covariance);
  return T_map_old;
}

void MapThenLocalize::set_anchors(const std::vector<UwbAnchor>& anchors_in_map) {
  anchors_in_map_ = anchors_in_map;
  range_biases_ = localize::RangeBiasMap(mapped_ranges_, anchors_in_map_, calibration_);
  current_->set_anchors(anchors_in_map_);
}

}  // namespace patrol::stack
