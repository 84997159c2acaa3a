#include "app/study/scan_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

TEST(ScannedWorlds, ScannersStandAtLeast60CentimetersFromAllSurfaces) {
  for (const ScannedWorld& world : scanned_worlds()) {
    const RayWorld rays(load_site(world.name, find_data_root("")).world_xml.string());
    ASSERT_EQ(world.scanners_m.size(), 12U) << world.name;
    for (const Eigen::Vector2d& p : world.scanners_m) {
      const double ground_m = rays.ground_m(p);
      for (int beam = 0; beam < 72; ++beam) {
        const double angle = 2.0 * std::numbers::pi * beam / 72;
        for (const double height_m : {0.4, 1.0, 1.7}) {
          EXPECT_FALSE(rays.scene().cast({p.x(), p.y(), ground_m + height_m}, {std::cos(angle), std::sin(angle), 0.0},
                                         0.6, sim::kRayScenery))
              << world.name << " (" << p.x() << ", " << p.y() << ") at " << height_m << " m";
        }
      }
    }
  }
}

TEST(ScannedWorlds, ScansReachDownToTheLowestElevationOfTheWorld) {
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
