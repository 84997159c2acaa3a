#pragma once

#include <optional>
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
  UwbAnchor anchor;  ///< anchor in map
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  int count = 0;
  Pose2 T_map_linearization;  ///< node pose at which the ranges were linearized
  /// Unit vector in map along which the range constrains the node; none: the range constrains the whole pose.
  std::optional<Eigen::Vector2d> direction = {};

  /// Pose at which the range is evaluated: the linearization pose moved along `direction`, or the node pose itself.
  Pose2 T_map_constrained(const Pose2& T_map_node) const;
};

/// UWB range factors of a pose graph, for directions that scans leave degenerate. Consecutive ranges have correlated
/// errors of decimeters, scans errors of millimeters; ranges therefore constrain the degenerate direction only. They
/// are averaged per node and anchor, which bounds their number.
class RangeFactors {
 public:
  RangeFactors() = default;
  explicit RangeFactors(RangeUpdateSettings settings) : settings_(std::move(settings)) {}

  /// Adds a range. `T_node_then` is the body pose at the measurement relative to the newest or second-newest node. The
  /// range is reduced to the node by the difference of the predicted ranges at the current node pose. The error of the
  /// reduction is 1 to 10 mm for a node error of 10 cm, 10 m from the anchor and 1 m from the node. `direction`, in
  /// map: see RangeFactor.
  void add(int node, const Pose2& T_map_node, const Pose2& T_node_then, const RangeMeasurement& measurement,
           const std::optional<Eigen::Vector2d>& direction = {});

  const std::vector<RangeFactor>& ranges() const { return ranges_; }  ///< in ascending node order
  const UwbCalibration& calibration() const { return settings_.calibration; }
  double std_m(const RangeFactor& range) const;

 private:
  RangeUpdateSettings settings_;
  std::vector<RangeFactor> ranges_;
};

}  // namespace patrol::slam
