#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/uwb.h"
#include "slam/methods/mapper.h"
#include "stack/localization/localizer.h"

namespace patrol::stack {

/// Localization in the map that SLAM is building.
class SlamLocalizer final : public Localizer {
 public:
  /// `T_body_uwb`: pose of the UWB antenna; none for a robot without one, which ignores ranges.
  /// `map_covariance`: covariance of x, y, yaw by the deformation of the map, added to that of each scan match.
  SlamLocalizer(std::unique_ptr<slam::Mapper> mapper, std::vector<UwbAnchor> anchors_in_map,
                std::optional<Pose3> T_body_uwb, const Eigen::Matrix3d& map_covariance = Eigen::Matrix3d::Zero());

  void add(const RangeWithOdometry& range) override;
  void add(const slam::PositionMeasurement& position) override { mapper_->add(position); }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) override;
  std::vector<Pose2> path() const override { return mapper_->path(); }
  OccupancyGrid map() override { return mapper_->map(); }
  std::vector<slam::MappedRange> mapped_ranges() const override { return mapper_->mapped_ranges(); }
  bool is_mapping() const override { return is_mapping_; }
  bool is_lost() const override { return false; }
  bool has_pose() const override { return true; }
  Pose2 finish_map(const PoseEstimate& pose) override;
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map) override {
    if (!mapper_->estimates_survey()) anchors_ = anchors_in_map;
  }
  void serialize_state(StateArchive& archive) override;

 private:
  std::unique_ptr<slam::Mapper> mapper_;
  std::vector<UwbAnchor> anchors_;
  std::optional<Pose3> T_body_uwb_;
  Eigen::Matrix3d map_covariance_;
  bool is_mapping_ = true;
};

}  // namespace patrol::stack
