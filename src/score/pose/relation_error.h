#pragma once

#include <cstddef>
#include <vector>

#include "core/pose_relation.h"
#include "core/settings.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Assignment of trajectory poses to the stamps of relations.
struct RelationSettings {
  static constexpr double kMaxDt_s = 10.0, kMaxReference_m = 10.0;  ///< limits of the settings
  /// maximum distance in time at which the nearest pose is used; beyond it the pose is interpolated
  double max_dt_s = 0.02;
  double reference_x_m = 0.0;  ///< x offset of the relations' reference point in the trajectory's body frame

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_dt_s", self.max_dt_s, between(0.0, kMaxDt_s));
    visit("ref_x_m", self.reference_x_m, between(-kMaxReference_m, kMaxReference_m));
  }
};

/// Mean and spread of a list of errors.
struct ErrorSpread {
  double mean = 0.0;
  double std = 0.0;  ///< population standard deviation: n in the denominator
};

/// Error of a trajectory relative to given true relative poses. No frame is fitted: each relation concerns only two
/// poses, so an early heading error is not counted again in every later pose.
struct RelationError {
  std::size_t num_relations = 0;  ///< number of scored relations: both stamps have a pose of the trajectory
  std::size_t num_given = 0;
  std::size_t num_stamps = 0;        ///< number of distinct stamps in the given relations
  std::size_t num_interpolated = 0;  ///< stamps with an interpolated pose: no pose is within `max_dt_s`
  std::size_t num_outside = 0;       ///< stamps without a pose: before the first or after the last one
  std::size_t num_in_holes = 0;      ///< stamps without a pose: in a hole of the trajectory (interpolation_limit.h)
  ErrorSpread trans_m, squared_trans_m2;
  double trans_median_m = 0.0, trans_max_m = 0.0;
  ErrorSpread rot_deg, squared_rot_deg2;
  double rot_median_deg = 0.0, rot_max_deg = 0.0;
};

/// Compares est(t1)^-1 est(t2) with each relation: distance of the translations and difference of the headings. The
/// metric is that of [Kuemmerle09] with translation and rotation apart. With an even number of relations the median is
/// the upper one. Throws InputError when the trajectory or the list of relations is empty, or no relation has poses of
/// the trajectory at both stamps.
RelationError relation_error(const Trajectory& T_map_body, const std::vector<PoseRelation>& relations,
                             const RelationSettings& settings = {});

}  // namespace patrol::score
