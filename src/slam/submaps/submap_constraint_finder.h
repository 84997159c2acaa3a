#pragma once

#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/settings.h"
#include "slam/pose_gaussian.h"
#include "slam/submaps/submap_surfaces.h"

namespace patrol::slam {

struct SubmapConstraintSettings {
  double min_margin = 0.2;         ///< minimum classifier margin (-1 ... 1) of neighbors
  /// The match is rejected if fine matching moves a submap farther from the coarse pose.
  double max_fine_shift_m = 0.5;
  double max_fine_shift_rad = 0.1;
  double min_overlap_consistency = 0.6;      ///< minimum inlier ratio (mutual_overlap_consistency)
  double max_window_m = 15.0;      ///< maximum half width of the search for a second-best match around the prediction
  double max_window_rad = 0.8;
  double max_second_best_ratio = 0.9;  ///< the match is rejected if a distinct pose scores more than this fraction of its score
  double min_second_best_distance_m = 0.8;   ///< poses at least this far from the match are distinct
  double min_second_best_angle_rad = 0.35;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_margin", self.min_margin, between(-1.0, 1.0));
    visit("max_fine_shift_m", self.max_fine_shift_m, at_least(0.0));
    visit("max_fine_shift_rad", self.max_fine_shift_rad, at_least(0.0));
    visit("min_overlap_consistency", self.min_overlap_consistency, between(0.0, 1.0));
    visit("max_window_m", self.max_window_m, between(0.1, 100.0));
    visit("max_window_rad", self.max_window_rad, between(0.01, 3.2));
    visit("max_second_best_ratio", self.max_second_best_ratio, between(0.0, 1.0));
    visit("min_second_best_distance_m", self.min_second_best_distance_m, at_least(0.0));
    visit("min_second_best_angle_rad", self.min_second_best_angle_rad, at_least(0.0));
  }
};

/// Reason for rejecting a submap pair.
enum class ConstraintRejection {
  kNone,
  kNotNeighbors,  ///< not recognized as neighbors
  kMismatch,   ///< coarse and fine matching disagree, or the inlier ratio is too small
  kAmbiguous,  ///< a second-best match has a similar score
};

/// Features and relative poses of a submap pair.
struct SurfaceMatch {
  std::vector<double> features;          ///< features of pair_features.h
  std::optional<NdtResult> coarse;
  std::optional<IcpResult> fine;         ///< refined from `coarse`
};

/// Matches coarsely by normal distributions from the prediction, then finely on effective neighbors [Yu23, section 2].
SurfaceMatch match_surfaces(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& T_target_source, const SubmapSurfaceSettings& settings);

struct SubmapConstraint {
  Pose2 T_target_source;
  /// Information of x, y, yaw in target, with independent points.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double margin = 0.0;
  double overlap_consistency = 0.0;
};

struct ConstraintResult {
  std::optional<SubmapConstraint> constraint;
  ConstraintRejection failure = ConstraintRejection::kNone;
};

/// Decides whether two submaps are neighbors and estimates their relative pose. `model` classifies the pair [Yu23,
/// section 3]; the pose is matched coarsely by normal distributions and finely on effective neighbors (section 2).
///
/// Extensions of [Yu23], which prevent matches shifted by one bay between identical bays:
/// - the fine match must stay near the coarse match;
/// - both submaps must agree on free and occupied cells;
/// - no other pose within three standard deviations of the prediction may score similarly.
ConstraintResult find_constraint(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& T_target_source, const BoostedStumps& model,
                        const SubmapSurfaceSettings& surfaces, const SubmapConstraintSettings& settings);

}  // namespace patrol::slam
