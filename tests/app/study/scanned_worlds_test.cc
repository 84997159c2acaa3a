#include "app/study/scanned_worlds.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/study/scan_world.h"

namespace patrol::app {
namespace {

TEST(ScannedWorlds, ScannersStandAtLeast60CentimetersFromAllSurfaces) {
  for (const ScannedWorld& world : scanned_worlds()) {
    const RayWorld rays(world_xml(world));
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

}  // namespace
}  // namespace patrol::app
