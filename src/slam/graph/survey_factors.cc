#include "slam/graph/survey_factors.h"

#include <algorithm>

namespace patrol::slam {

bool SurveyFactors::constrain(int first, int last) const {
  const auto has_factor = [&](const auto& factors) {
    const auto next = std::ranges::lower_bound(factors, first, {}, [](const auto& factor) { return factor.node; });
    return next != factors.end() && next->node <= last;
  };
  return has_factor(ranges.ranges()) || has_factor(positions.positions());
}

}  // namespace patrol::slam
