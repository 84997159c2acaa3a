#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "localize/amcl/beam_model_settings.h"
#include "localize/amcl/sensor_model.h"

namespace patrol::localize {

/// Returns log p(z | z_expected) of one range, 1/m, or of no return (+Inf) [Thrun05, table 6.1, equations 6.4 to 6.11].
double beam_log_likelihood(double range_m, double expected_m, const BeamModelSettings& settings);

/// Beam model: the expected range of every beam is found by ray casting in the map. More expensive and less smooth than
/// the likelihood field, but it accounts for occlusion.
class BeamModel final : public SensorModel {
 public:
  BeamModel(const BeamModelSettings& settings, const OccupancyGrid& map);

  /// Likelihoods are relative to that of an exact range at 1 m, so that 0 is approximately the maximum.
  ScanLikelihoods evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const override;

  /// Distance to the first occupied cell, at most `max_range_m`, m; accurate to one cell.
  double expected_range_m(const Eigen::Vector2d& p_map_origin, double angle_rad) const;

 private:
  BeamModelSettings settings_;
  Grid<float> distance_m_;
};

}  // namespace patrol::localize
