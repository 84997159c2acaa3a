#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "localize/amcl/range_bias_map.h"
#include "stack/localization/localizer.h"

namespace patrol::stack {

/// SLAM until the map is complete, then Monte Carlo localization on that map. The UWB ranges are corrected by their
/// errors in the mapping: without that, they contradict the map by centimeters.
class MapThenLocalize final : public Localizer {
 public:
  using LocalizerFactory = std::function<std::unique_ptr<Localizer>(OccupancyGrid)>;

  /// `make_on_map` makes the localizer for the complete map, with `anchors_in_map`. `calibration`: bias of the UWB
  /// ranges for which that localizer accounts.
  MapThenLocalize(std::unique_ptr<Localizer> slam, std::vector<UwbAnchor> anchors_in_map, LocalizerFactory make_on_map,
                  UwbCalibration calibration = {});

  void add(const RangeWithOdometry& range) override;
  void add(const slam::PositionMeasurement& position) override { current_->add(position); }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) override;
  std::vector<Pose2> path() const override { return is_mapping() ? current_->path() : path_of_mapping_; }
  OccupancyGrid map() override { return current_->map(); }
  bool is_mapping() const override { return current_->is_mapping(); }
  bool is_lost() const override { return current_->is_lost(); }
  bool has_pose() const override { return current_->has_pose(); }
  Pose2 finish_map(const PoseEstimate& pose) override;
  void set_initial_pose(const Pose2& T_map_body, const Eigen::Matrix3d& covariance) override {
    current_->set_initial_pose(T_map_body, covariance);
  }
  void start_global_localization() override { current_->start_global_localization(); }
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map) override;
  void serialize_state(StateArchive& archive) override;

 private:
  std::unique_ptr<Localizer> current_;
  LocalizerFactory make_on_map_;
  UwbCalibration calibration_;
  std::vector<UwbAnchor> anchors_in_map_;
  std::vector<Pose2> path_of_mapping_;            ///< [scan] once the map is complete
  std::vector<slam::MappedRange> mapped_ranges_;  ///< once the map is complete
  localize::RangeBiasMap range_biases_;           ///< once the map is complete
  std::optional<Eigen::Vector2d> p_map_body_;     ///< position at the newest scan; none without a confident pose
};

}  // namespace patrol::stack
