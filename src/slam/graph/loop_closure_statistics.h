#pragma once

#include "slam/graph/submap_matcher.h"

namespace patrol::slam {

/// Numbers of loop closure searches by result.
struct LoopClosureStatistics {
  int searched = 0, closed = 0, not_found = 0, ambiguous = 0, no_overlap = 0, mismatched = 0;

  void add(MatchFailure failure);
};

}  // namespace patrol::slam
