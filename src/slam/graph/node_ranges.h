#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/uwb.h"
#include "slam/range_update.h"

namespace patrol::slam {

/// The mean of the ranges from one anchor around one node of a pose graph, as if all had been read at the node.
struct NodeRange {
  int node = 0;
  UwbAnchor anchor;  ///< in map
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  int count = 0;
  Pose2 T_map_read;  ///< where the node was believed
  std::optional<Eigen::Vector2d> direction = {};  ///< in map: all that it is asked about, the rest being known; none: all of the pose

  /// What the range speaks of, were the node there.
  Pose2 T_map_judged(const Pose2& T_map_node) const;
};

/// What holds a graph where scans leave a direction open: UWB ranges. They err by decimetres that they share with their neighbours, where a scan errs by
/// millimetres; so they speak of that direction alone. Gathered at its nodes so that they are no more than nodes times anchors.
class NodeRanges {
 public:
  NodeRanges() = default;
  explicit NodeRanges(const RangeUpdateSettings& settings) : settings_(settings) {}

  /// `T_node_then`: where the body was at the sighting, as seen from the newest node or the one before. The way between them is taken out by its difference
  /// in predicted range, with the node where it is believed now: 10 cm off, 10 m from the anchor and a metre from the node that errs by a millimetre or ten.
  /// `direction`, in map: see NodeRange.
  void add(int node, const Pose2& T_map_node, const Pose2& T_node_then, const RangeSighting& sighting, const std::optional<Eigen::Vector2d>& direction = {});

  const std::vector<NodeRange>& ranges() const { return ranges_; }  ///< by node, the oldest first
  const UwbCalibration& calibration() const { return settings_.calibration; }
  double std_m(const NodeRange& range) const;

 private:
  RangeUpdateSettings settings_;
  std::vector<NodeRange> ranges_;
};

}  // namespace patrol::slam
