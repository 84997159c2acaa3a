#pragma once

#include <vector>

#include "render/film/moment.h"
#include "render/film/run_history.h"

namespace patrol::render {

struct MomentSettings {
  double near_miss_m = 1.0;        ///< a clearance to somebody below this is one
  int most_near_misses = 3;        ///< the nearest of them
  double least_error_m = 0.03;     ///< a largest error below this is not worth a word
  double correction_m = 0.25;      ///< the estimate jumps by at least this
  double kidnap_m = 0.5;           ///< nobody walks this far from one truth to the next
};

/// A run's notable moments in order of time. What only the scenario knows (which faults it switched on) comes with `announced`.
/// `T_world_map`: where the map's own places are.
std::vector<Moment> find_moments(const RunHistory& history, const Pose2& T_world_map, std::vector<Moment> announced = {},
                                 const MomentSettings& settings = {});

}  // namespace patrol::render
