#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "localize/amcl/line_field.h"
#include "localize/amcl/sensor_model.h"

namespace patrol::localize {

struct LikelihoodFieldSettings {
  double hit_std_m = 0.1;       ///< of a beam's end about the nearest surface: range, map and tilt together
  double random_share = 0.05;   ///< likelihood of an end far from every surface, next to one on a surface
  int max_beams = 180;          ///< of a scan that are looked at; more cost time in proportion

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("hit_std_m", self.hit_std_m, between(0.01, 2.0));
    visit("random_share", self.random_share, between(1e-4, 0.5));
    visit("max_beams", self.max_beams, between(10, 10000));
  }
};

/// Ends of beams in level, m: x and y apart, so that four are turned at once.
struct BeamEnds {
  std::vector<float> x_m, y_m;
  std::size_t size() const { return x_m.size(); }
};

/// The ends of at most `max_beams` hits, evenly spread over the scan.
BeamEnds select_beam_ends(const LevelScan& scan, int max_beams);

/// The likelihood-field model (Thrun et al. 2005, table 6.3): a beam's end at distance d from the nearest surface has the
/// likelihood z_hit exp(-d^2 / 2 sigma^2) + z_rand. It is smooth, and people and trucks that the map does not know cost a
/// pose no more than z_rand a beam, wherever they stand.
///
/// Three departures. Near surfaces the distance is that to the line through the cells (line_field.h): noise in the map leaves
/// ragged walls, and hundreds of beams find their own place on a ragged wall, the same wrong place scan after scan, where
/// the tunnel itself is smooth. The mixture is scaled to 1 at d = 0, z_rand = `random_share` and z_hit = 1 - z_rand: a constant factor.
/// And log-likelihoods are stored in 256 levels, 0.012 apart at z_rand = 0.05: a map of a tunnel then stays in the
/// processor's cache, and sums of integers do not depend on their order.
class LikelihoodField final : public SensorModel {
 public:
  LikelihoodField(const LikelihoodFieldSettings& settings, const OccupancyGrid& map, const LineField& lines);

  ScanLikelihoods evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const override;

  /// Mean over the ends of log(likelihood / largest); 0 if there are none.
  double mean_log(const BeamEnds& ends, const Pose2& T_map_body) const;
  /// Of one point of the map.
  double log_at(const Eigen::Vector2d& p_map) const;

 private:
  int level_at(int col, int row) const { return level_[static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(col)]; }

  LikelihoodFieldSettings settings_;
  double inverse_resolution_;
  Eigen::Vector2d corner_m_;  ///< lower left corner of level_[0], in map
  float max_col_, max_row_;   ///< of the frame
  std::size_t stride_;
  double level_step_;                 ///< log-likelihood = -level * step
  std::vector<std::uint8_t> level_;   ///< [row * stride + col], with a frame of one cell round the map that stands for all outside
};

}  // namespace patrol::localize
