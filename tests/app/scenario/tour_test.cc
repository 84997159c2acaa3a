#include "app/scenario/tour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::app::tour_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Tour, APoseHasTwoOrThreeNumbersAndWithoutAHeadingThatOfItsWay) {
  const PlanarPoseSettings pose = parse_pose("3,-4.5,90", "--goal", {});
  EXPECT_EQ(pose.x_m, 3.0);
  EXPECT_EQ(pose.y_m, -4.5);
  EXPECT_EQ(pose.heading_deg, 90.0);
  EXPECT_NEAR(parse_pose("1,2", "--goal", {.x_m = 1.0, .y_m = 1.0}).heading_deg, 90.0, 1e-12);
  for (const char* wrong : {"", "1", "1,", "1,2,", "1,2,3,4", "1;2", "a,b", "1,nan", "1,2,400", "1e999,0", " 1,2"}) {
    EXPECT_THAT([&] { parse_pose(wrong, "--goal", {}); },
                ThrowsMessage<InputError>(HasSubstr("must be X,Y or X,Y,DEG")))
        << wrong;
  }
}

TEST(Tour, TheLastStationIsHomeAndNamesAreFilledIn) {
  const Route route = route_of({.stations = {{.name = "pump", .x_m = 1.0}, {.heading_deg = 180.0}}});
  ASSERT_EQ(route.stations.size(), 2u);
  EXPECT_EQ(route.stations[0].name, "pump");
  EXPECT_EQ(route.stations[0].type, StationType::kPass);
  EXPECT_EQ(route.stations[1].name, "station_2");
  EXPECT_EQ(route.stations[1].type, StationType::kHome);
  EXPECT_EQ(route.stations[1].T_route_body.yaw, to_rad(180.0));
}

TEST(Tour, ItsOverridesMakeAScenarioWithoutAFile) {
  const TourSettings tour{.start = {.x_m = 11.0, .y_m = 8.0, .heading_deg = 90.0},
                          .stations = {{.name = "goal_1", .x_m = 11.0, .y_m = 15.25, .accuracy_m = 0.1}}};
  std::vector<std::string> overrides = overrides_of(tour);
  overrides.emplace_back("world=street");
  const Scenario scenario = load_scenario({}, overrides);
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root({}));
  ASSERT_EQ(files.route.stations.size(), 1u);
  EXPECT_EQ(files.route.stations[0].T_route_body.y, 15.25);
  EXPECT_EQ(files.route.stations[0].accuracy_m, 0.1);
  EXPECT_EQ(files.T_site_start.x, 11.0);
  EXPECT_THAT(files.mission_text, HasSubstr("goal_1"));
}

TEST(Tour, AndAMissionFileExcludeEachOtherAndOneOfThemIsNeeded) {
  Scenario scenario;
  scenario.world = "street";
  EXPECT_THAT([&] { load_scenario_files(scenario, find_data_root({})); },
              ThrowsMessage<InputError>(HasSubstr("mission: missing")));
  scenario.mission = "routes/short.json";
  scenario.tour.stations.emplace_back();
  EXPECT_THAT([&] { load_scenario_files(scenario, find_data_root({})); },
              ThrowsMessage<InputError>(HasSubstr("mission and tour are mutually exclusive")));
  EXPECT_THAT([&] { load_scenario_files({}, find_data_root({})); },
              ThrowsMessage<InputError>(HasSubstr("world: missing")));
}

}  // namespace
}  // namespace patrol::app::tour_test
