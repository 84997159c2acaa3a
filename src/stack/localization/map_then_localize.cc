#include "stack/localization/map_then_localize.h"

#include <utility>

namespace patrol::stack {

MapThenLocalize::MapThenLocalize(std::unique_ptr<Localizer> slam, OnMap on_map)
    : current_(std::move(slam)), on_map_(std::move(on_map)) {}

void MapThenLocalize::finish_map(const PoseEstimate& pose) {
  if (!current_->is_mapping()) return;
  current_ = on_map_(current_->map());
  current_->start_at(pose.T_map_body, pose.covariance);
}

}  // namespace patrol::stack
