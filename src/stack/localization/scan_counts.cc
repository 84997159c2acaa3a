#include "stack/localization/scan_counts.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::stack {

void ScanCounts::add(const std::optional<LevelScan>& level, double max_tilt_rad) {
  ++num_received;
  if (!level) ++num_without_pose;
  else if (std::ranges::none_of(level->beams, &LevelScan::Beam::is_hit)) ++num_without_hits;
  else if (level->tilt_rad > max_tilt_rad) ++num_tilted;
}

std::string ScanCounts::failure_text(double max_tilt_rad) const {
  if (num_received == 0) return "No map: the sensor lidar published no scan.";
  std::vector<std::string> reasons;
  if (num_without_hits > 0)
    reasons.push_back(fmt::format("{} without a hit on anything but the robot", num_without_hits));
  if (num_tilted > 0) reasons.push_back(fmt::format("{} tilted by more than {:.3g} rad", num_tilted, max_tilt_rad));
  if (num_without_pose > 0) reasons.push_back(fmt::format("{} without odometry", num_without_pose));
  return fmt::format("No map: of {} scans of the sensor lidar none was used: {}.", num_received, join(reasons, ", "));
}

}  // namespace patrol::stack
