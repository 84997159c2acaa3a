#pragma once

#include <optional>

#include "core/boosted_stumps.h"
#include "core/settings.h"
#include "slam/pose_gaussian.h"
#include "slam/submaps/submap_surfaces.h"

namespace patrol::slam {

struct SubmapJoinerSettings {
  double min_margin = 0.0;         ///< a vote above this, -1 ... 1, says that two submaps are neighbours
  double max_fine_shift_m = 0.5;   ///< fine matching that moves a submap farther has left the place that was recognised
  double max_fine_shift_rad = 0.1;
  double min_agreement = 0.6;      ///< of either's points that lie where the other has looked, that meet a surface there
  double max_window_m = 15.0;      ///< around the prediction, each way, that is searched for a rival
  double max_window_rad = 0.8;
  double rival_share = 0.9;        ///< another pose that fits more than so much as well makes the match worthless
  double rival_distance_m = 0.8;   ///< so far off it is another
  double rival_angle_rad = 0.35;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_margin", self.min_margin, between(-1.0, 1.0));
    visit("max_fine_shift_m", self.max_fine_shift_m, at_least(0.0));
    visit("max_fine_shift_rad", self.max_fine_shift_rad, at_least(0.0));
    visit("min_agreement", self.min_agreement, between(0.0, 1.0));
    visit("max_window_m", self.max_window_m, between(0.1, 100.0));
    visit("max_window_rad", self.max_window_rad, between(0.01, 3.2));
    visit("rival_share", self.rival_share, between(0.0, 1.0));
    visit("rival_distance_m", self.rival_distance_m, at_least(0.0));
    visit("rival_angle_rad", self.rival_angle_rad, at_least(0.0));
  }
};

/// Why two submaps were not joined.
enum class JoinFailure {
  kNone,
  kStrangers,  ///< not recognised as neighbours
  kMismatch,   ///< coarse and fine matching do not agree, or surfaces lie where the other has seen none
  kAmbiguous,  ///< another place would do as well
};

struct SubmapJoint {
  Pose2 T_target_source;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in target, as if all points were independent
  double margin = 0.0;
  double agreement = 0.0;
};

struct JoinResult {
  std::optional<SubmapJoint> joint;
  JoinFailure failure = JoinFailure::kNone;
};

/// Whether the two are neighbours, and how they lie to each other: recognised by `model` (paper 002, section 3), matched coarsely by normal distributions and
/// finely on effective neighbours (section 2).
///
/// Not in the paper: the matching may not leave the place that was recognised, both must agree on what is free and what is not, and no other place within
/// three standard deviations of the prediction may fit as well. Bays that are all alike are otherwise joined one off.
JoinResult join_submaps(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& T_target_source, const BoostedStumps& model,
                        const SubmapSurfaceSettings& surfaces, const SubmapJoinerSettings& settings);

}  // namespace patrol::slam
