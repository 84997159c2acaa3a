#include "localize/map_correction.h"

#include <algorithm>

namespace patrol::localize {

Pose2 MapCorrection::at(Time stamp) const {
  if (stamps.empty()) return {};
  const auto after = std::ranges::upper_bound(stamps, stamp) - stamps.begin();
  return T_map_old[static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - 1, 0))];
}

}  // namespace patrol::localize
