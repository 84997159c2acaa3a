#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "slam/submaps/effective_neighbor_icp_settings.h"
#include "slam/submaps/point_tree.h"

namespace patrol::slam {

/// Target or source points of an alignment, prepared once for several alignments.
class IcpPoints {
 public:
  /// `facings` [point]: free-space normals (surface_points.h); empty: pairs are not gated by normals.
  IcpPoints(std::vector<Eigen::Vector2d> points, const IcpSettings& settings,
            std::vector<Eigen::Vector2d> free_space_normals = {})
      : tree_(std::move(points)),
        normals_(surface_normals(tree_, settings.normal_radius_m)),
        free_space_normals_(std::move(free_space_normals)) {
    free_space_normals_.resize(tree_.points().size(), Eigen::Vector2d::Zero());
  }

  const std::vector<Eigen::Vector2d>& points() const { return tree_.points(); }
  const PointTree& tree() const { return tree_; }
  const std::vector<SurfaceNormal>& normals() const { return normals_; }
  const std::vector<Eigen::Vector2d>& free_space_normals() const { return free_space_normals_; }

 private:
  PointTree tree_;
  std::vector<SurfaceNormal> normals_;
  std::vector<Eigen::Vector2d> free_space_normals_;
};

struct IcpResult {
  Pose2 T_target_source;
  /// Information of x, y, yaw in target, from independent pairs with their distances across the target's walls. Near
  /// zero along a corridor, although point pairs resist motion there too.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_pairs = 0;         ///< number of effective pairs in the last iteration
  double threshold_m = 0.0;  ///< largest distance of an effective pair
  double rms_m = 0.0;        ///< root mean square of the distances of the effective pairs
  int iterations = 0;
  bool converged = false;
};

/// Threshold distance of effective neighbors [Yu23, eqs. 7, 8]. The input is sorted in ascending order and not empty.
///
/// Eq. 7 is the chord from the first to the last distance, L(k) = (a_n - a_1) / (n - 1) (k - 1) + a_1. Eq. 8 is the
/// deviation of the k-th distance from it.
///
/// Deviations from [Yu23]: the sign in eq. 8 is illegible, and the text continues "when D_k - D_(k-1) < 0 take
/// a_(k-1)". Here D_k = L(k) - a_k. The rule then selects the first maximum of the deviation, which is the global
/// maximum on a convex curve. Measured curves have ripples that would end the search at the second pair, so the global
/// maximum is used; among equal ones the last. If no distance is below the chord, all pairs are kept.
double effective_threshold(const std::vector<double>& sorted_distances);

/// ICP [Besl92] on effective neighbors [Yu23, section 2.2]. In every iteration, each source point is paired with its
/// nearest target point, and pairs beyond the threshold are dropped. Points outside the overlap thus have no influence.
/// Returns none if fewer than `min_pairs` remain.
///
/// Deviations from [Yu23], all of which can be switched off:
/// - Pairs with opposite free-space normals are rejected; otherwise the two sides of a wall would be aligned.
/// - The threshold has a lower bound; otherwise fully overlapping submaps would be matched on their best pairs only and
///   converge early.
/// - The threshold has an upper bound. Without it, the bend of the curve is meters off if most points have no partner
///   (a switchyard). The match is then worse than its start.
/// - Final steps use distances to lines where the target is linear and to points elsewhere (Generalized-ICP in the
///   plane [Segal09]). Near pairs have larger weights, because the points of two submaps are different samples of the
///   walls and would otherwise lock onto each other's pattern.
std::optional<IcpResult> align_icp(const IcpPoints& target, const IcpPoints& source, const Pose2& T_start,
                                   const IcpSettings& settings);

}  // namespace patrol::slam
