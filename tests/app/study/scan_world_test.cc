#include "app/study/scan_world.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

TEST(ScanWorld, ScansReachDownToTheLowestElevationOfTheWorld) {
  ScannedWorld world = scanned_worlds().at(1);
  world.step_deg = 2.0;
  world.scanners_m.resize(world.guest_scan + 1);
  for (const io::StationScan& scan : take_scans(world, 11)) {
    double lowest = 1.0;
    for (const ScannerPoint& point : scan.points) {
      const Eigen::Vector3d d = Eigen::Vector3d(point.x, point.y, point.z) - scan.T_map_scanner.position;
      lowest = std::min(lowest, d.normalized().z());
    }
    EXPECT_NEAR(lowest, std::sin(to_rad(world.elevation_min_deg)), 0.01);
  }
}

}  // namespace
}  // namespace patrol::app
