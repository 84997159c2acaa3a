#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/named_table.h"
#include "core/pose_graph.h"
#include "slam/graph/scan_tracker.h"
#include "slam/rbpf/trajectory_rbpf.h"

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

/// Settings of the method `rbpf`, in one section with those of its filter. The defaults are those for a recorded log, whose odometry is of unknown
/// quality. A robot of this program has odometry of known quality: its stack uses the odometry as given and fewer particles.
struct ScanOdometryRbpfSettings {
  std::string odometry = "scan_matched";  ///< odometry that predicts the particles (`kRbpfOdometries`)
  ScanTrackerSettings scan_odometry;           ///< matching from scan to scan, with `odometry: scan_matched`
  GridSlamSettings filter = default_filter_settings();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("odometry", self.odometry, one_of(kRbpfOdometries));
    visit("scan_odometry", self.scan_odometry);
    GridSlamSettings::fields(self.filter, visit);
  }
};

/// Rao-Blackwellized particle filter on grids (grid_slam.h), the method `rbpf` of runs and of recorded logs. Gmapping's filter; loops are closed only by
/// particles that return to the right pose.
///
/// With `odometry: scan_matched`, matching from scan to scan corrects the odometry before the filter uses it: the particles have only its small errors to
/// correct, and wrong wheel odometry does not mislead all of them.
class ScanOdometryRbpf {
 public:
  ScanOdometryRbpf(const ScanOdometryRbpfSettings& settings, std::uint64_t seed);

  /// A range between scans; left out before the first scan.
  void add(RangeMeasurement measurement);
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  /// Trajectory of the currently best particle, [scan].
  std::vector<Pose2> path() const { return filtered_.path(); }
  OccupancyGrid map() const { return filtered_.map(); }
  ParticleSet particles() const { return filtered_.particles(); }
  PoseGraph graph() const { return filtered_.graph(); }
  std::vector<std::size_t> node_scan_indices() const { return filtered_.node_scan_indices(); }

 private:
  /// Poses of the newest scan in the given and in the corrected odometry.
  struct OdometryPair {
    Pose2 T_odom_body, T_local_body;
  };

  std::optional<ScanTracker> tracker_;  ///< none with `odometry: given`
  std::optional<OdometryPair> newest_;  ///< with a tracker
  TrajectoryRbpf filtered_;
};

}  // namespace patrol::slam
