#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "localize/amcl/likelihood_field_settings.h"
#include "localize/amcl/line_field.h"
#include "localize/amcl/sensor_model.h"

namespace patrol::localize {

/// End points of beams in level, m, with separate x and y arrays for vectorization.
struct BeamEnds {
  std::vector<float> x_m, y_m;
  std::size_t size() const { return x_m.size(); }
};

/// Selects at most `max_beams` hits, spread uniformly over the scan.
BeamEnds select_beam_ends(const LevelScan& scan, int max_beams);

/// Likelihood-field model [Thrun05, table 6.3]: the likelihood of a beam's end at distance d from the nearest surface
/// is z_hit exp(-d^2 / 2 sigma^2) + z_rand. It is smooth, and an unmapped obstacle reduces the likelihood by at most
/// the factor z_rand per beam, wherever it is.
///
/// Deviations from [Thrun05]:
/// - Near surfaces, d is the distance to the line through the cells (line_field.h). Map noise makes walls ragged, and
///   hundreds of beams would match that pattern at the same wrong position in every scan.
/// - The mixture is scaled to 1 at d = 0, with z_rand = `z_rand` and z_hit = 1 - z_rand: a constant factor.
/// - Log likelihoods are quantized to 256 levels, 0.012 apart for z_rand = 0.05. The map of a tunnel then fits in the
///   processor cache, and integer sums do not depend on their order.
class LikelihoodField final : public SensorModel {
 public:
  LikelihoodField(const LikelihoodFieldSettings& settings, const OccupancyGrid& map, const LineField& lines);

  ScanLikelihoods evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const override;

  /// Mean over the ends of log(likelihood / maximum); 0 if there are none.
  double mean_log(const BeamEnds& ends, const Pose2& T_map_body) const;
  /// Log likelihood of a point in map, relative to the maximum.
  double log_at(const Eigen::Vector2d& p_map) const;

 private:
  int level_at(int col, int row) const {
    return level_[static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(col)];
  }

  LikelihoodFieldSettings settings_;
  double inverse_resolution_;
  Eigen::Vector2d corner_m_;  ///< lower left corner of level_[0], in map
  float max_col_, max_row_;   ///< indices of the last column and row, including the frame
  std::size_t stride_;
  double level_step_;  ///< log likelihood = -level * step
  /// [row * stride + col], with a frame of one cell around the map that represents everything outside
  std::vector<std::uint8_t> level_;
};

}  // namespace patrol::localize
