#pragma once

#include <vector>

#include "render/film/highlight.h"
#include "render/film/run_history.h"

namespace patrol::render {

/// Thresholds for the detection of highlights.
struct HighlightSettings {
  double near_miss_m = 1.0;    ///< clearance to an actor below which an approach is a near miss
  int max_near_misses = 3;     ///< maximum number of near misses; the closest are kept
  double min_error_m = 0.03;   ///< minimum value of the maximum error to be listed
  double correction_m = 0.25;  ///< minimum jump of the estimate's error
  double kidnap_m = 0.5;       ///< minimum step between two true poses for a kidnapping
};

/// Finds the highlights of a run in order of time. `announced` contains events known only to the scenario, e.g.
/// injected faults. `T_world_map` transforms event positions from map to world.
std::vector<Highlight> find_highlights(const RunHistory& history, const Pose2& T_world_map,
                                       std::vector<Highlight> announced = {}, const HighlightSettings& settings = {});

}  // namespace patrol::render
