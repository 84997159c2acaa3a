#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/settings.h"
#include "slam/submaps/point_tree.h"

namespace patrol::slam {

struct IcpSettings {
  bool use_effective_neighbours = true;  ///< false: all pairs, plain ICP
  double min_threshold_m = 0.1;  ///< pairs nearer than this are effective in any case: below about a spacing a distance is the points' pattern
  double max_threshold_m = 0.3;  ///< and pairs farther apart are not: a coarse matching leaves less than this
  bool refine_on_lines = true;   ///< goes on with the distances across the target's walls, once those from point to point have converged
  double line_threshold_m = 0.1; ///< the farthest that pairs may be apart then
  double line_kernel_m = 0.04;   ///< and those that are so far apart count half
  int max_iterations = 100;
  double step_tol_m = 1e-5;     ///< a smaller step ends it; seen 10 m away
  int min_pairs = 10;           ///< fewer are no match
  double point_std_m = 0.03;    ///< of a point across its wall, for the information
  double normal_radius_m = 0.3; ///< neighbourhood whose principal axis is a wall's normal

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("use_effective_neighbours", self.use_effective_neighbours);
    visit("min_threshold_m", self.min_threshold_m, at_least(0.0));
    visit("max_threshold_m", self.max_threshold_m, at_least(0.0));
    visit("refine_on_lines", self.refine_on_lines);
    visit("line_threshold_m", self.line_threshold_m, between(1e-3, 10.0));
    visit("line_kernel_m", self.line_kernel_m, between(1e-3, 10.0));
    visit("max_iterations", self.max_iterations, between(1, 100000));
    visit("step_tol_m", self.step_tol_m, between(0.0, 1.0));
    visit("min_pairs", self.min_pairs, between(2, 100000));
    visit("point_std_m", self.point_std_m, between(1e-4, 10.0));
    visit("normal_radius_m", self.normal_radius_m, between(1e-3, 10.0));
  }
};

/// Points that are laid on others, or on which others are laid: made once, matched often.
class IcpPoints {
 public:
  /// `facings` [point]: from which side it was seen (surface_points.h); without any, points are points.
  IcpPoints(std::vector<Eigen::Vector2d> points, const IcpSettings& settings, std::vector<Eigen::Vector2d> facings = {})
      : tree_(std::move(points)), normals_(surface_normals(tree_, settings.normal_radius_m)), facings_(std::move(facings)) {
    facings_.resize(tree_.points().size(), Eigen::Vector2d::Zero());
  }

  const std::vector<Eigen::Vector2d>& points() const { return tree_.points(); }
  const PointTree& tree() const { return tree_; }
  const std::vector<SurfaceNormal>& normals() const { return normals_; }
  const std::vector<Eigen::Vector2d>& facings() const { return facings_; }

 private:
  PointTree tree_;
  std::vector<SurfaceNormal> normals_;
  std::vector<Eigen::Vector2d> facings_;
};

struct IcpResult {
  Pose2 T_target_source;
  /// Of x, y, yaw in target, of the pairs across the target's walls, as if all were independent. Along a corridor it is next to none, though pairs of
  /// points hold each other there too.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_pairs = 0;         ///< effective ones, at the end
  double threshold_m = 0.0;  ///< the longest distance of an effective pair
  double rms_m = 0.0;        ///< of their distances
  int iterations = 0;
  bool converged = false;
};

/// The distance up to which pairs are effective neighbours (paper 002, eqs. 7 and 8), of distances sorted in ascending order, at least one.
///
/// Eq. 7 is the chord from the first to the last, L(k) = (a_n - a_1) / (n - 1) (k - 1) + a_1, eq. 8 the departure of the k-th from it. The sign of eq. 8 cannot
/// be read; the text goes on "when D_k - D_(k-1) < 0 take a_(k-1)". With D_k = L(k) - a_k, how far the k-th lies below the chord, that is where the
/// departure stops growing: on a curve that bends upwards only, its largest value. Real curves have ripples, the first of which would end it at the second
/// pair already, so the largest departure of all is taken; of equal ones the last. Where none lies below the chord there is no bend, and all are kept.
double effective_threshold(const std::vector<double>& sorted_distances);

/// The rigid motion with the smallest sum of squared distances from source to target points, pair by pair, in closed form (paper 002, eqs. 9 to 12: both
/// centred, then the rotation, then T = mu_p - R mu_q). At least one pair.
Pose2 fit_rigid_motion(const std::vector<Eigen::Vector2d>& points_target, const std::vector<Eigen::Vector2d>& points_source);

/// Iterated closest points (Besl, McKay 1992) on effective neighbours (paper 002, section 2.2): every source point with its nearest target point, the pairs
/// past the threshold dropped, anew in every iteration, so that what lies beyond the common part does not pull. None if fewer than `min_pairs` are left.
///
/// Four things are not the paper's, and can be switched off: pairs that were seen from opposite sides are none, or a wall's two faces come to lie on each
/// other; the least threshold, without which submaps that overlap wholly are matched on their best pairs only and stop half way; the largest, without which the bend of the curve lies metres off where most points have no partner (a switchyard), and the
/// match is worse than the one that it began at; and the steps at the end on lines where the target is straight and on points where it is not (Segal, Haehnel,
/// Thrun, "Generalized-ICP", RSS 2009, in the plane), near pairs counting most, since two submaps' points are never the same pieces of wall, and lock like
/// two combs.
std::optional<IcpResult> align_icp(const IcpPoints& target, const IcpPoints& source, const Pose2& T_start, const IcpSettings& settings);

}  // namespace patrol::slam
