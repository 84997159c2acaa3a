#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "stack/localization/localizer.h"

namespace patrol::stack {

/// SLAM until the map is complete, then Monte Carlo localization on that map, with the delays of the UWB anchors that
/// SLAM has estimated: without them, the ranges contradict the map by centimeters.
class MapThenLocalize final : public Localizer {
 public:
  using LocalizerFactory = std::function<std::unique_ptr<Localizer>(OccupancyGrid)>;

  /// `make_on_map` makes the localizer for the complete map.
  MapThenLocalize(std::unique_ptr<Localizer> slam, LocalizerFactory make_on_map);

  void add(const RangeWithOdometry& range) override;
  void add(const slam::PositionMeasurement& position) override { current_->add(position); }
  PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) override {
    return current_->update(scan, T_odom_body, output);
  }
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

 private:
  std::unique_ptr<Localizer> current_;
  LocalizerFactory make_on_map_;
  std::map<int, double> range_delays_m_;                  ///< [anchor number] once the map is complete
  std::vector<Pose2> path_of_mapping_;                    ///< [scan] once the map is complete
  std::optional<std::vector<UwbAnchor>> anchors_in_map_;  ///< once they have moved
};

}  // namespace patrol::stack
