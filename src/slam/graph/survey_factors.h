#pragma once

#include "slam/graph/position_factors.h"
#include "slam/graph/range_factors.h"

namespace patrol::slam {

/// Factors between single nodes of a pose graph and the survey.
struct SurveyFactors {
  RangeFactors ranges;
  PositionFactors positions;

  /// Returns whether a node of `first` to `last` has a factor.
  bool constrain(int first, int last) const;
};

}  // namespace patrol::slam
