#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/check/check_robot.h"
#include "app/check/maneuver.h"

namespace patrol::app {

/// Result of a check drive.
struct CheckResult {
  CheckRobot robot;
  std::vector<std::string> warnings;  ///< warnings about its lidars (blocked_beams.h, scan_reach.h)
  std::vector<ManeuverResult> maneuvers;

  bool is_passed() const;
  /// Returns the number of maneuvers that failed.
  std::size_t num_failed() const;
};

/// Called with the title of the present maneuver and the completed fraction of the check. Throws to abort the check.
using CheckProgress = std::function<void(const std::string& title, double fraction)>;

/// Drives all maneuvers, each in a simulator of its own. Equal robots give equal results.
CheckResult run_check(const CheckRobot& robot, const CheckProgress& progress);

}  // namespace patrol::app
