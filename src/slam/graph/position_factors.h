#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "slam/graph/position_factors_settings.h"
#include "slam/position_measurement.h"

namespace patrol::slam {

/// Position of an antenna near one node of a pose graph.
struct PositionFactor {
  int node = 0;
  Eigen::Vector2d p_node_antenna = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_survey_antenna = Eigen::Vector2d::Zero();
  double std_m = 0.0;
};

/// Position factors of a pose graph. They hold the shape of the map over distances at which scans drift. The pose of
/// map in survey is estimated with the nodes.
///
/// Positions have errors that are correlated over tens of seconds. Positions at an interval dt < 2 tau enter with a
/// standard deviation larger by sqrt(2 tau / dt), so that their mean over a long time has its true accuracy.
class PositionFactors {
 public:
  explicit PositionFactors(const PositionFactorsSettings& settings = {}) : settings_(settings) {}

  /// Adds a position, at most one per node; positions too close in time to the previous one are ignored. `T_node_then`:
  /// body pose at the measurement relative to the newest node.
  void add(int node, const Pose2& T_node_then, const PositionMeasurement& measurement);

  const std::vector<PositionFactor>& positions() const { return positions_; }  ///< in ascending node order
  const PositionFactorsSettings& settings() const { return settings_; }
  /// Pose of map in survey; the identity before the first optimization.
  const Pose2& T_survey_map() const { return T_survey_map_; }
  void set_survey(const Pose2& T_survey_map) { T_survey_map_ = T_survey_map; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(positions_, last_, T_survey_map_);
  }

 private:
  PositionFactorsSettings settings_;
  std::vector<PositionFactor> positions_;
  std::optional<Time> last_;
  Pose2 T_survey_map_;
};

}  // namespace patrol::slam
