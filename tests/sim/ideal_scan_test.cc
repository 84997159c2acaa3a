#include "sim/ideal_scan.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/sim/small_world.h"

namespace patrol::sim::ideal_scan_test {
namespace {

// A wall that fills the half plane x > 2: its range along an angle is 2 / cos(angle).
TEST(IdealScan, AWallIsMetByTheBeamsThatAreNeitherTooFlatNorTooLong) {
  const SmallWorld world(R"(<geom type="box" pos="3 0 0" size="1 100 5"/>)");
  const auto returns =
      ideal_scan(world.scene, {0.0, 0.0, 0.5}, {.beams = 3600, .range_max_m = 30.0, .max_incidence_deg = 60.0});
  EXPECT_EQ(returns.size(), 1201u);  // -60 ... 60 degrees, ends included
  for (const BeamReturn& beam : returns) {
    EXPECT_NEAR(beam.range_m, 2.0 / beam.direction.x(), 1e-4);
    EXPECT_NEAR(beam.normal.x(), -1.0, 1e-5);
  }
  const auto near =
      ideal_scan(world.scene, {0.0, 0.0, 0.5},
                 {.beams = 3600, .range_max_m = 2.0 / std::cos(std::numbers::pi / 6.0), .max_incidence_deg = 85.0});
  EXPECT_NEAR(static_cast<double>(near.size()), 601.0, 2.0);
}

TEST(IdealScan, NothingAroundIsNoReturn) {
  const SmallWorld world(R"(<geom type="box" pos="50 0 0" size="1 1 1"/>)");
  EXPECT_TRUE(ideal_scan(world.scene, {0.0, 0.0, 0.5}, {}).empty());
}

}  // namespace
}  // namespace patrol::sim::ideal_scan_test
