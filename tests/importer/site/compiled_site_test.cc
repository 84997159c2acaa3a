#include "importer/site/compiled_site.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/mujoco.h"

namespace patrol::importer::compiled_site_test {
namespace {

const std::string kPlane = R"(<geom type="plane" size="0 0 1"/>)";

sim::ModelPtr model_of(const std::string& geoms) {
  return sim::compile(*sim::parse_spec("<mujoco><worldbody>" + geoms + "</worldbody></mujoco>"), "site");
}

/// Row of a subject for a robot with a lidar 0.55 m above the ground; empty if there is none.
std::string row_of(const std::string& geoms, const std::string& subject) {
  ImportedSite site{.name = "site", .source = "site.world"};
  site.lidar_height_m = 0.55;
  for (const Assumption& row : rows_of_compiled(*model_of(geoms), site)) {
    if (row.subject == subject) return row.text;
  }
  return {};
}

std::string low(const std::string& geoms) { return row_of(geoms, "low obstacles"); }

TEST(CompiledSite, WallsThatEndBelowTheLidarAreCountedWithTheLargestHeight) {
  const std::string walls = R"(<geom name="low" type="box" size="2 0.05 0.15" pos="0 2 0.15"/>
      <geom name="high" type="box" size="0.05 2 0.25" pos="2 0 0.25" euler="0 0 0.3"/>
      <geom name="wall" type="box" size="0.05 2 0.3" pos="-2 0 0.3"/>)";
  EXPECT_EQ(
      low(kPlane + walls),
      "2 shapes with contact below the lidar of wheeled (0.55 m), which does not measure them, up to 0.50 m high: "
      "low, high");
  // The same on a platform 3 m high, whose own sides are no obstacles.
  EXPECT_THAT(low(R"(<geom type="box" size="9 9 0.5" pos="0 0 -0.5"/>)" + walls), ::testing::HasSubstr("2 shapes"));
}

TEST(CompiledSite, ShapesWithoutContactCurbsAndObjectsOnATableAreNoLowObstacles) {
  EXPECT_EQ(low(kPlane + R"(<geom type="box" size="1 1 0.2" pos="0 0 0.2" contype="0" conaffinity="0"/>)"), "");
  EXPECT_EQ(low(kPlane + R"(<geom type="box" size="4 1 0.07" pos="0 0 0.07"/>)"), "");
  EXPECT_EQ(low(kPlane + R"(<geom type="box" size="0.4 0.6 0.02" pos="0 0 0.75"/>
                            <geom type="box" size="0.1 0.1 0.1" pos="0 0 0.87"/>)"),
            "");
}

TEST(CompiledSite, ABaseThatStandsOutLessThanAQuarterMeterIsMeasuredByWhatIsAbove) {
  const auto base = [](double half_m) {
    return kPlane + R"(<geom type="box" size="2 0.1 1" pos="0 0 1"/>)" +
           fmt::format(R"(<geom type="box" size="{} {} 0.1" pos="0 0 0.1"/>)", 1.9 + half_m, half_m);
  };
  EXPECT_EQ(low(base(0.15)), "");
  EXPECT_THAT(low(base(0.5)), ::testing::HasSubstr("1 shape with"));
}

TEST(CompiledSite, WithoutALidarThereIsNoRowAboutLowObstacles) {
  EXPECT_TRUE(rows_of_compiled(*model_of(kPlane + R"(<geom type="box" size="1 1 0.2" pos="0 0 0.2"/>)"),
                               {.name = "site", .source = "site.world"})
                  .empty());
}

TEST(CompiledSite, ASiteOfObjectsHasNoGround) {
  EXPECT_THAT(row_of(R"(<geom type="box" size="0.5 0.5 1" pos="3 0 1"/><geom type="box" size="5 0.1 1" pos="0 3 1"/>)",
                     "no ground"),
              ::testing::HasSubstr("runs are refused"));
  EXPECT_EQ(row_of(kPlane, "no ground"), "");
  EXPECT_EQ(row_of(R"(<geom type="box" size="1 1 0.05"/><geom type="box" size="0.5 0.5 1" pos="0 0 1"/>)", "no ground"),
            "");
  EXPECT_EQ(row_of(R"(<geom type="box" size="5 5 1" pos="0 0 4"/><geom type="box" size="0.1 0.1 1"/>)", "no ground"),
            "");
}

TEST(CompiledSite, GeomsFartherThan100kmAreRefusedByName) {
  const sim::ModelPtr near = model_of(R"(<geom name="wall" type="box" size="1 1 1" pos="0 -99000 0"/>)");
  EXPECT_NO_THROW(check_coordinates(*near, "room.world"));
  const sim::ModelPtr far = model_of(R"(<geom name="wall" type="box" size="1 1 1" pos="450012.5 -5412345.25 32"/>)");
  EXPECT_THAT([&] { check_coordinates(*far, "room.world"); },
              ::testing::ThrowsMessage<InputError>("room.world: wall: coordinates up to 5.41e+06 m: must be at most "
                                                   "100000 m: move the origin of the file near the site"));
  const sim::ModelPtr large = model_of(R"(<geom name="wall" type="box" size="1 1 1e9"/>)");
  EXPECT_THROW(check_coordinates(*large, "room.world"), InputError);
}

}  // namespace
}  // namespace patrol::importer::compiled_site_test
