#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/named_table.h"
#include "core/settings.h"
#include "slam/graph/scan_tracker_settings.h"
#include "slam/rbpf/grid_slam_settings.h"

namespace patrol::slam {

/// Filter settings for scan-to-scan odometry: enough particles for a building, small motion noise, no leg-specific
/// errors.
GridSlamSettings default_filter_settings();

/// Odometry that predicts the particles of `rbpf`.
enum class RbpfOdometry : std::uint8_t { kGiven, kScanMatched };

inline constexpr std::array kRbpfOdometries = std::to_array<NamedValue<RbpfOdometry>>({
    {RbpfOdometry::kGiven, "given", "The odometry of the robot or the log, as given"},
    {RbpfOdometry::kScanMatched, "scan_matched", "The given odometry, corrected by matching from scan to scan"},
});
static_assert(is_in_order(kRbpfOdometries));

/// Settings of the method `rbpf`, in one section with those of its filter. The defaults are those for a recorded log,
/// whose odometry is of unknown quality. A robot of this program has odometry of known quality: its stack uses the
/// odometry as given and fewer particles.
struct ScanOdometryRbpfSettings {
  std::string odometry = "scan_matched";  ///< odometry that predicts the particles (`kRbpfOdometries`)
  ScanTrackerSettings scan_odometry;      ///< matching from scan to scan, with `odometry: scan_matched`
  GridSlamSettings filter = default_filter_settings();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("odometry", self.odometry, one_of(kRbpfOdometries));
    visit("scan_odometry", self.scan_odometry);
    GridSlamSettings::fields(self.filter, visit);
  }
};

}  // namespace patrol::slam
