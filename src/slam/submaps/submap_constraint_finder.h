#pragma once

#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/settings.h"
#include "slam/pose_gaussian.h"
#include "slam/submaps/submap_constraint_finder_settings.h"
#include "slam/submaps/submap_surfaces.h"

namespace patrol::slam {

/// Reason for rejecting a submap pair.
enum class ConstraintRejection {
  kNone,
  kNotNeighbors,  ///< submaps not recognized as neighbors
  kMismatch,      ///< coarse and fine matching disagree, or the inlier ratio is too small
  kAmbiguous,     ///< a second-best match has a similar score
};

/// Features and relative poses of a submap pair.
struct SurfaceMatch {
  std::vector<double> features;  ///< features of pair_features.h
  std::optional<NdtResult> coarse;
  std::optional<IcpResult> fine;  ///< refined from `coarse`
};

/// Matches coarsely by normal distributions from the prediction, then finely on effective neighbors [Yu23, section 2].
SurfaceMatch match_surfaces(const SubmapSurfaces& target, const SubmapSurfaces& source,
                            const PoseGaussian& T_target_source, const SubmapSurfaceSettings& settings);

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
ConstraintResult find_constraint(const SubmapSurfaces& target, const SubmapSurfaces& source,
                                 const PoseGaussian& T_target_source, const BoostedStumps& model,
                                 const SubmapSurfaceSettings& surfaces, const SubmapConstraintSettings& settings);

}  // namespace patrol::slam
