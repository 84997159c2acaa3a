#include "app/plan/plan_settings.h"

#include <cmath>

#include <gtest/gtest.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "plan/routes/global_planner.h"

namespace patrol::app::plan_settings_test {
namespace {

PlanOptions options_of(std::vector<std::string> overrides) {
  return {.map = "m.yaml", .overrides = std::move(overrides)};
}

std::string complaint(const PlanOptions& options) {
  try {
    load_plan_setup(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PlanSettings, APointWeighsNoCostsAndCrossesNothingUnknown) {
  const PlanSetup setup = load_plan_setup({.map = "m.yaml"});
  EXPECT_FALSE(setup.body.footprint);
  EXPECT_EQ(setup.settings.routes.cost_weight, 0.0);
  EXPECT_FALSE(setup.settings.costmap.allow_unknown);
}

TEST(PlanSettings, ADiscsOutlineHoldsTheDiscAndNoMoreThanHalfAPercentBeyond) {
  const PlanSetup setup = load_plan_setup({.map = "m.yaml", .radius_m = 0.4});
  EXPECT_NEAR(setup.body.footprint->inscribed_radius_m(), 0.4, 1e-12);
  EXPECT_LT(setup.body.footprint->circumscribed_radius_m(), 0.4 * 1.005);
  EXPECT_EQ(setup.settings.routes.cost_weight, plan::GlobalPlannerSettings().family.cost_weight);
}

TEST(PlanSettings, ARobotsAreThoseThatItDrivesWithUnderWhatIsSet) {
  const plan::NavigatorSettings drives_with = default_scenario("tracked", find_data_root("")).stack.navigation;
  const PlanSetup setup =
      load_plan_setup({.map = "m.yaml", .robot = "tracked", .overrides = {"costmap.safety_margin_m=0.2"}});
  EXPECT_EQ(setup.settings.costmap.route_margin_m, drives_with.costmap.route_margin_m);
  EXPECT_EQ(setup.settings.costmap.inflation_radius_m, drives_with.costmap.inflation_radius_m);
  EXPECT_EQ(setup.settings.costmap.safety_margin_m, 0.2);
  EXPECT_EQ(setup.settings.costmap.allow_unknown, drives_with.costmap.allow_unknown);
  EXPECT_EQ(setup.settings.routes.cost_weight, drives_with.global_planner.family.cost_weight);
  EXPECT_EQ(setup.settings.speed_mps, drives_with.local_planner.dwa.max_speed_mps);
  EXPECT_TRUE(load_plan_setup({.map = "m.yaml", .robot = "tracked", .overrides = {"allow_unknown=true"}})
                  .settings.costmap.allow_unknown);
}

TEST(PlanSettings, OptionsWinOverSet) {
  const PlanSetup setup = load_plan_setup({.map = "m.yaml",
                                           .planner = "astar",
                                           .smooth = true,
                                           .speed_mps = 0.5,
                                           .seed = 9,
                                           .overrides = {"planner=dijkstra", "seed=3"}});
  EXPECT_EQ(setup.settings.planner, "astar");
  EXPECT_EQ(setup.settings.seed, 9u);
  EXPECT_TRUE(setup.settings.smooth);
  EXPECT_EQ(setup.settings.speed_mps, 0.5);
}

TEST(PlanSettings, WhatIsWrongIsNamed) {
  const std::string unknown_planner = complaint({.map = "m.yaml", .planner = "fly"});
  EXPECT_EQ(unknown_planner.find("--planner fly: must be one of astar, dijkstra, theta_star"), 0u) << unknown_planner;
  const std::string unknown_robot = complaint({.map = "m.yaml", .robot = "hovering"});
  EXPECT_EQ(unknown_robot.find("robot = hovering: "), 0u) << unknown_robot;
  EXPECT_NE(unknown_robot.find("hovering.urdf not found (known: cart, quadruped, tracked, wheeled)"), std::string::npos)
      << unknown_robot;
  EXPECT_EQ(complaint({.map = "m.yaml", .robot = "tracked", .radius_m = 0.3}),
            "--robot and --radius-m are mutually exclusive");
  EXPECT_EQ(complaint({.map = "m.yaml", .radius_m = 0.0}), "--radius-m: 0: must be in [0.01, 10]");
  EXPECT_EQ(complaint({.map = "m.yaml", .radius_m = std::nan("")}), "--radius-m: nan: must be in [0.01, 10]");
  EXPECT_EQ(complaint({.map = "m.yaml", .planner = "visibility_graph", .smooth = true}).substr(0, 9), "--smooth:");
  EXPECT_NE(complaint({.map = "m.yaml", .planner = "visibility_graph", .robot = "tracked"}).find("routes.cost_weight"),
            std::string::npos);
  EXPECT_NE(complaint(options_of({"allow_unknown=maybe"})).find("--set allow_unknown=maybe: must be true or false"),
            std::string::npos)
      << complaint(options_of({"allow_unknown=maybe"}));
  EXPECT_EQ(complaint(options_of({"costmap.crosses_unknown=true"})),
            "--set: costmap.allow_unknown: not supported: use allow_unknown=true or allow_unknown=false");
  EXPECT_NE(complaint(options_of({"routes.ant_colony.antz=3"})).find("routes.ant_colony.antz"), std::string::npos);
  EXPECT_NE(complaint(options_of({"speed_mps=0"})).find("speed_mps"), std::string::npos);
}

}  // namespace
}  // namespace patrol::app::plan_settings_test
