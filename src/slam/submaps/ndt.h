#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/grid.h"
#include "slam/submaps/ndt_settings.h"

namespace patrol::slam {

/// Score of points at a pose, with derivatives with respect to x, y, yaw of T_target_source.
struct NdtScore {
  double value = 0.0;                                  ///< sum over the points, each 0 ... 1
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< exact gradient
  /// Gauss-Newton approximation of the Hessian of -value, positive semidefinite
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
};

/// Normal distributions transform of points at one cell size ([Biber03]; [Yu23, eqs. 4, 5]).
///
/// The four grids of [Biber03], shifted by half a cell each, form one lattice: nodes half a cell apart with a cell
/// around each. A point belongs to the four cells that contain it, with bilinear weights that sum to 1 and vanish on
/// the cell border. The score is therefore continuous, and its gradient exact.
class NdtGrid {
 public:
  /// `points_target` in target, m. Standard deviations of a normal below `min_std_m` are increased to it. Throws
  /// InputError if a point is not finite or if the lattice exceeds 4,000 nodes along an axis.
  NdtGrid(const std::vector<Eigen::Vector2d>& points_target, double cell_m, double min_std_m);

  /// Sum over the points of exp(-1/2 q^T Sigma^-1 q), with q relative to the mean of the cell [Biber03, eq. 6]. The
  /// four cells of a point have bilinear weights.
  ///
  /// Deviation from [Yu23, eq. 6], which sums the logarithms: for a single normal that is an unbounded parabola. Points
  /// without a partner, frequent in partly overlapping submaps, would then dominate. Without the logarithm their
  /// influence vanishes.
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
  Eigen::Vector2d origin_m_;  ///< position of node (0, 0)
  Grid<int> cell_of_node_;    ///< -1: no cell
  std::vector<NormalCell> cells_;
};

/// Computes the transforms of a submap at all cell sizes, coarse to fine.
std::vector<NdtGrid> make_ndt(const std::vector<Eigen::Vector2d>& points_target, const NdtSettings& settings);

struct NdtResult {
  Pose2 T_target_source;
  /// Information of x, y, yaw in target: negative Hessian of the score of the finest level, with independent points.
  /// Computed by finite differences instead of the Gauss-Newton curvature, in which the cells of a wall also constrain
  /// points along the wall. Along a corridor it is near zero.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double score = 0.0;  ///< mean over the source points on the finest level, 0 ... 1; points without a partner have 0
  int iterations = 0;  ///< sum over all levels
  bool converged = false;  ///< convergence on the finest level
};

/// Pose of maximum score near `T_start`, for coarse matching [Yu23, eq. 6]: Gauss-Newton with Levenberg-Marquardt
/// damping; steps that lower the score are rejected. Every level starts from `T_start` and from all results of the
/// coarser level: wide cells have a large capture range but are biased in partial overlaps. The result with the highest
/// score on the finest level is returned. Returns none if no cell responds to any source point.
std::optional<NdtResult> align_ndt(const std::vector<NdtGrid>& target,
                                   const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_start,
                                   const NdtSettings& settings);

/// Regular subset of at most `max_points` points.
std::vector<Eigen::Vector2d> subsample(const std::vector<Eigen::Vector2d>& points, int max_points);

}  // namespace patrol::slam
