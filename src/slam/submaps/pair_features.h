#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slam/pose_gaussian.h"
#include "slam/submaps/submap_shape.h"

namespace patrol::slam {

/// What tells whether two submaps are neighbours, that is hold a part of the world in common: for AdaBoost (paper 002, section 3, which says that the
/// features of a pair are learnt from but not which). Lengths are in the two submaps' radii together, so that the size of a submap does not matter. None
/// depends on where in the world or in their own frames the submaps lie; what is read from cells, histograms of directions and matching does so by less
/// than their resolution.
///
///   center_distance        of the two centres as predicted, in radii together
///   center_mahalanobis     the same in standard deviations of the prediction; at most 30
///   center_std             the prediction's largest standard deviation of the one centre in the other submap, in radii together
///   hull_overlap           common area of the convex hulls as predicted, of the smaller one's
///   seen_overlap           cells seen by both as predicted, of those that the one saw who saw fewer
///   distance_difference    of the histograms of distances between points: 0 ... 1; needs no pose
///   direction_correlation  of the histograms of the walls' directions, the best of all turns: -1 ... 1; needs no pose
///   direction_predicted    the same at the turn predicted
///   point_ratio            points of the one with fewer, of the other's; needs no pose
///   radius_ratio           smaller radius, of the larger; needs no pose
///   score_predicted        NDT score on the second coarsest cells as predicted, the smaller of both directions: 0 ... 1
///   score_aligned          NDT score on the finest cells at the pose that NDT finds from the prediction on, likewise
///   aligned_mahalanobis    how far that pose is from the prediction, in standard deviations; at most 30
///   aligned_agreement      mutual_agreement there
inline constexpr std::array<const char*, 14> kPairFeatures = {
    "center_distance",     "center_mahalanobis", "center_std",   "hull_overlap",    "seen_overlap",  "distance_difference", "direction_correlation",
    "direction_predicted", "point_ratio",        "radius_ratio", "score_predicted", "score_aligned", "aligned_mahalanobis", "aligned_agreement"};

std::vector<std::string> pair_feature_names();

/// Of the one's points that lie where the other has looked, the share that lie on a surface of the other; the smaller of both directions. 0 if fewer than a
/// tenth of either's points lie where the other has looked.
double mutual_agreement(const SubmapShape& target, const SubmapShape& source, const Pose2& T_target_source);

/// Whether their centres may lie within both radii of each other, two standard deviations off the prediction.
bool may_be_neighbours(const SubmapShape& target, const SubmapShape& source, const PoseGaussian& T_target_source);

struct SubmapComparison {
  std::vector<double> features;      ///< [feature] as above, all finite
  std::optional<NdtResult> aligned;  ///< none if the submaps do not feel each other
};

/// `T_target_source` as predicted by odometry or the graph. Takes one NDT matching.
SubmapComparison compare_submaps(const SubmapShape& target, const SubmapShape& source, const PoseGaussian& T_target_source, const NdtSettings& settings);

}  // namespace patrol::slam
