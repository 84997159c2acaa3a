#pragma once

#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/uwb.h"
#include "slam/range_update.h"

namespace patrol::slam {

/// Mean of the ranges from one anchor near one node of a pose graph, reduced to the node's pose.
struct RangeFactor {
  int node = 0;
  UwbAnchor anchor_in_survey;
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  int count = 0;
};

/// UWB range factors of a pose graph. They hold the shape of the map over distances at which scans drift, and the
/// direction that scans leave degenerate. They are averaged per node and anchor, which bounds their number. The ranges
/// to an anchor have one delay in common, which is estimated with the poses.
class RangeFactors {
 public:
  RangeFactors() = default;
  explicit RangeFactors(RangeUpdateSettings settings) : settings_(std::move(settings)) {}

  /// Adds a range to an anchor in survey. `T_survey_node`: present pose of the node. `T_node_then`: body pose at the
  /// measurement relative to the newest or second-newest node. The range is reduced to the node by the difference of
  /// the predicted ranges at the present node pose. The error of the reduction is 1 to 10 mm for a node error of 10 cm,
  /// 10 m from the anchor and 1 m from the node.
  void add(int node, const Pose2& T_survey_node, const Pose2& T_node_then, const RangeMeasurement& measurement);

  const std::vector<RangeFactor>& ranges() const { return ranges_; }  ///< in ascending node order
  const UwbCalibration& calibration() const { return settings_.calibration; }
  /// Standard deviation of the mean: independent noise, and an error that all ranges near a node have in common.
  double std_m(const RangeFactor& range) const;
  double outlier_scale_sigma() const { return settings_.outlier_scale_sigma; }
  double delay_std_m() const { return settings_.anchor_delay_std_m; }  ///< standard deviation of the prior; mean 0

  /// Estimated delay of an anchor, m; zero before the first optimization with a range to it.
  double delay_m(int anchor) const;
  void set_delays(std::map<int, double> delays_m) { delays_m_ = std::move(delays_m); }
  const std::map<int, double>& delays_m() const { return delays_m_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(delays_m_, ranges_);
  }

 private:
  RangeUpdateSettings settings_;
  std::map<int, double> delays_m_;  ///< [anchor number]
  std::vector<RangeFactor> ranges_;
};

}  // namespace patrol::slam
