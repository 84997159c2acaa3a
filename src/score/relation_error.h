#pragma once

#include <cstddef>
#include <vector>

#include "core/pose_relation.h"
#include "core/settings.h"
#include "core/trajectory.h"

namespace patrol::score {

struct RelationSettings {
  double max_dt_s = 0.02;  ///< a pose within this of a relation's stamp is taken as it is; else it is interpolated
  double ref_x_m = 0.0;    ///< the point that the relations are about lies this far ahead of the trajectory's body

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_dt_s", self.max_dt_s, between(0.0, 10.0));
    visit("ref_x_m", self.ref_x_m, between(-10.0, 10.0));
  }
};

/// Of a list of errors.
struct ErrorSpread {
  double mean = 0.0;
  double std = 0.0;  ///< of the list itself: n in the denominator
};

/// How well a trajectory keeps the relations between places that are known to be true. No frame is fitted: each relation is about two
/// poses alone, so that a bend early in the trajectory is not counted over and over.
struct RelationError {
  std::size_t num_relations = 0;
  std::size_t num_stamps = 0;        ///< different ones, in the relations
  std::size_t num_interpolated = 0;  ///< of these: no pose of the trajectory was near enough
  std::size_t num_outside = 0;       ///< of the interpolated: before the first pose or after the last, which is taken
  ErrorSpread trans_m, squared_trans_m2;
  double trans_median_m = 0.0, trans_max_m = 0.0;
  ErrorSpread rot_deg, squared_rot_deg2;
  double rot_median_deg = 0.0, rot_max_deg = 0.0;
};

/// The error of a relation is the distance between est(t1)^-1 est(t2) and it, and between their headings (Kuemmerle et al., "On measuring
/// the accuracy of SLAM algorithms", Autonomous Robots 2009, with the two parts apart). Of an even number the median is the
/// upper one. Throws InputError when the trajectory or the relations are empty.
RelationError relation_error(const Trajectory& T_map_body, const std::vector<PoseRelation>& relations, const RelationSettings& settings = {});

}  // namespace patrol::score
