#include "stack/localization/map_then_localize.h"

#include <utility>

namespace patrol::stack {

MapThenLocalize::MapThenLocalize(std::unique_ptr<Localizer> slam, LocalizerFactory make_on_map)
    : current_(std::move(slam)), make_on_map_(std::move(make_on_map)) {}

void MapThenLocalize::finish_map(const PoseEstimate& pose) {
  if (!current_->is_mapping()) return;
  current_ = make_on_map_(current_->map());
  current_->set_initial_pose(pose.T_map_body, pose.covariance);
}

}  // namespace patrol::stack
