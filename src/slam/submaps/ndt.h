#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/settings.h"

namespace patrol::slam {

struct NdtSettings {
  std::vector<double> cells_m = {8.0, 4.0, 2.0, 1.0, 0.5};  ///< sides of the cells, level by level, coarse first
  double min_std_per_cell = 0.15;  ///< a normal is at least this wide in any direction, in sides of its cell: how far a wall is felt
  int max_points = 800;            ///< of the source; if it has more, every so many
  int max_iterations = 60;         ///< on each level
  double step_tol_per_cell = 5e-4; ///< a step that moves points 10 m away by less than this, in sides of the cell, ends a level

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cells_m", self.cells_m, between(0.05, 100.0));
    visit("min_std_per_cell", self.min_std_per_cell, between(0.001, 1.0));
    visit("max_points", self.max_points, between(3, 1000000));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("step_tol_per_cell", self.step_tol_per_cell, between(1e-9, 0.1));
  }
};

/// The score of points at a pose and its derivatives by x, y, yaw of T_target_source.
struct NdtScore {
  double value = 0.0;                                   ///< sum over the points, each 0 ... 1
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();   ///< exact
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();  ///< of -value, approximated so that it is never negative (Gauss-Newton)
};

/// The normal distributions transform of points (Biber, Strasser, "The normal distributions transform: a new approach to laser scan matching", IROS 2003;
/// paper 002, eqs. 4, 5) at one size of cells.
///
/// Biber's four grids, each shifted by half a cell, are one lattice of nodes here, half a cell apart, with a cell around each. A point counts in the four
/// cells that hold it by bilinear weights, which are 1 together and 0 on a cell's border: so the score has no jumps, and its gradient is what it says.
class NdtGrid {
 public:
  /// `points_target` in target, m. A normal whose smaller standard deviation is below `min_std_m` is widened to it. Throws InputError when a point is not
  /// finite, or when they lie more than 4,000 nodes apart.
  NdtGrid(const std::vector<Eigen::Vector2d>& points_target, double cell_m, double min_std_m);

  /// Sum over the points of exp(-1/2 q^T Sigma^-1 q), q from the mean of the cell (Biber's score, his eq. 6), by bilinear weights over the four cells.
  ///
  /// Paper 002's eq. 6 has the sum of the logarithms instead. Of one normal alone that is a parabola without bound, and the points that have no partner, of
  /// which partly overlapping submaps have most, would pull hardest. Without the logarithm they are not felt.
  NdtScore score(const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_target_source) const;

  double cell_m() const { return 2.0 * node_spacing_m_; }
  std::size_t num_cells() const { return cells_.size(); }

 private:
  struct NormalCell {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  };
  void add(const Eigen::Vector2d& p_target, const Eigen::Vector2d& arm, NdtScore& sum) const;

  double node_spacing_m_;
  Eigen::Vector2d origin_m_;  ///< of node (0, 0)
  Grid<int> cell_of_node_;    ///< -1: nothing is there
  std::vector<NormalCell> cells_;
};

/// A submap's transform at every size of cells, coarse first: made once, matched often.
std::vector<NdtGrid> make_ndt(const std::vector<Eigen::Vector2d>& points_target, const NdtSettings& settings);

struct NdtResult {
  Pose2 T_target_source;
  /// Of x, y, yaw in target: how the finest level's score falls off around the pose, as if all points were independent. Measured by differences, not the
  /// curvature of Gauss-Newton, in which a wall's cells hold a point along the wall as well: along a corridor there is next to none.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double score = 0.0;  ///< mean over the source's points on the finest level, 0 ... 1; a point without a partner counts 0
  int iterations = 0;  ///< of all levels together
  bool converged = false;  ///< on the finest level
};

/// The pose of largest score near `T_start` (paper 002's coarse matching, eq. 6): Gauss-Newton with Levenberg's damping, which takes no step that lowers
/// the score. Every level climbs from the start and from all poses that the coarser ones ended at, since wide cells see far but are pulled off where
/// submaps overlap in part only; the pose that the finest level scores highest is taken. None if no point of the source is felt by any of its cells.
std::optional<NdtResult> align_ndt(const std::vector<NdtGrid>& target, const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_start,
                                   const NdtSettings& settings);

/// At most `max_points` of the points, evenly taken: every so many.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& points, int max_points);

}  // namespace patrol::slam
