#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "localize/amcl/monte_carlo.h"
#include "stack/localization/localizer.h"

namespace patrol::stack {

/// Monte Carlo localization on a fixed map.
class KnownMapLocalizer final : public Localizer {
 public:
  /// `height_above_ground_m`: height of the origin of the standing body. `map_covariance`: of the map's own
  /// deformation, which is added to the pose. `calibration`: bias of the UWB ranges.
  KnownMapLocalizer(const localize::MonteCarloSettings& settings, OccupancyGrid map,
                    const std::vector<UwbAnchor>& anchors_in_map, double height_above_ground_m, const Pose3& T_body_uwb,
                    const Eigen::Matrix3d& map_covariance, std::uint64_t seed, const UwbCalibration& calibration);

  using Localizer::add;
  void add(const RangeWithOdometry& range) override { localizer_.add(range.range, range.T_odom_body); }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) override;
  OccupancyGrid map() override { return map_; }
  bool is_mapping() const override { return false; }
  bool is_lost() const override { return confidence_.is_lost; }
  bool has_pose() const override { return confidence_.stamp > Time{} && !confidence_.is_lost; }
  void set_initial_pose(const Pose2& T_map_body, const Eigen::Matrix3d& covariance) override {
    localizer_.set_initial_pose(T_map_body, covariance);
  }
  void start_global_localization() override { localizer_.start_global_localization(); }
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map) override;
  void serialize_state(StateArchive& archive) override;

 private:
  OccupancyGrid map_;
  double height_above_ground_m_;
  Eigen::Matrix3d map_covariance_;
  localize::MonteCarloLocalizer localizer_;
  LocalizationConfidence confidence_{.confidence = 1.0};  ///< confidence at the newest scan
};

}  // namespace patrol::stack
