#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slam/pose_gaussian.h"
#include "slam/submaps/submap_descriptor.h"

namespace patrol::slam {

/// Names of the features of a submap pair. AdaBoost classifies from them whether the submaps are neighbors, that is,
/// overlap [Yu23, section 3]. The source does not list its features.
///
/// Lengths are relative to the sum of the two submap radii, so that the submap size does not matter. No feature depends
/// on the world pose or on the frames of the submaps. Features from cells, direction histograms and matching depend on
/// them by less than their resolution.
///
///   center_distance        distance between the two predicted centers, relative to the sum of radii
///   center_mahalanobis     that distance in standard deviations of the prediction; at most 30
///   center_std             largest standard deviation of the predicted center, relative to the sum of radii
///   hull_overlap           common area of the predicted convex hulls, relative to the smaller hull
///   observed_overlap           number of cells observed by both as predicted, relative to the smaller number
///   distance_difference    difference of the distance histograms: 0 ... 1; independent of the pose
///   direction_correlation  maximum correlation of the direction histograms: -1 ... 1; independent of the pose
///   direction_predicted    correlation of the direction histograms at the predicted rotation: -1 ... 1
///   point_ratio            smaller number of points relative to the larger; independent of the pose
///   radius_ratio           smaller radius relative to the larger; independent of the pose
///   score_predicted        NDT score on the second-coarsest cells as predicted, minimum of both directions: 0 ... 1
///   score_aligned          NDT score on the finest cells at the NDT result, minimum of both directions: 0 ... 1
///   aligned_mahalanobis    distance of the NDT result from the prediction, in standard deviations; at most 30
///   aligned_agreement      mutual_overlap_consistency at the NDT result
inline constexpr std::array<const char*, 14> kPairFeatures = {
    "center_distance",     "center_mahalanobis",    "center_std",          "hull_overlap",     "seen_overlap",
    "distance_difference", "direction_correlation", "direction_predicted", "point_ratio",      "radius_ratio",
    "score_predicted",     "score_aligned",         "aligned_mahalanobis", "aligned_agreement"};

std::vector<std::string> pair_feature_names();

/// Inlier ratio of two submaps: points on a surface of the other / points in observed cells of the other, minimum of
/// both directions. 0 if fewer than a tenth of the points of either are in observed cells of the other.
double mutual_overlap_consistency(const SubmapDescriptor& target, const SubmapDescriptor& source,
                                  const Pose2& T_target_source);

/// Returns whether the distance of the centers, minus two standard deviations of the prediction, is below the sum of
/// the radii.
bool may_be_neighbors(const SubmapDescriptor& a, const SubmapDescriptor& b, const PoseGaussian& T_a_b);

struct SubmapComparison {
  std::vector<double> features;      ///< [feature] in the order of kPairFeatures, all finite
  std::optional<NdtResult> aligned;  ///< none if no cell of the target responds to the source
};

/// Computes the features of a pair with one NDT alignment. `T_target_source` is predicted by odometry or the graph.
SubmapComparison compare_submaps(const SubmapDescriptor& target, const SubmapDescriptor& source,
                                 const PoseGaussian& T_target_source, const NdtSettings& settings);

}  // namespace patrol::slam
