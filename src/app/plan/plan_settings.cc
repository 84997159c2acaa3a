#include "app/plan/plan_settings.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/named_table.h"
#include "core/text.h"
#include "io/yaml/settings_yaml.h"
#include "plan/routes/global_planner.h"
#include "plan/routes/planners.h"

namespace patrol::app {
namespace {

/// Regular polygon around a disc, which is its inscribed circle.
plan::Footprint outline_of_disc(double radius_m) {
  constexpr int kCorners = 32;
  const double corner_m = radius_m / std::cos(std::numbers::pi / kCorners);
  std::vector<Eigen::Vector2d> corners_m;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    corners_m.emplace_back(corner_m * std::cos(angle), corner_m * std::sin(angle));
  }
  return plan::Footprint(corners_m);
}

void set_robot(const std::string& robot, const std::filesystem::path& data_root, PlanSetup& setup) {
  const Scenario scenario = default_scenario(robot, data_root);
  setup.body = {.name = robot,
                .footprint = plan::Footprint(load_robot(robot, data_root, scenario.mounts).description.footprint_m)};
  const plan::NavigatorSettings& drives_with = scenario.stack.navigation;
  setup.settings.costmap = drives_with.costmap;
  setup.settings.allow_unknown = drives_with.costmap.allow_unknown;
  setup.settings.routes = drives_with.global_planner.family;
  setup.settings.min_clearance_m = drives_with.global_planner.min_clearance_m;
  setup.settings.speed_mps = drives_with.local_planner.dwa.max_speed_mps;
}

void set_disc(double radius_m, PlanSetup& setup) {
  if (!(radius_m >= 0.01 && radius_m <= 10.0))
    throw InputError(fmt::format("--radius-m: {}: must be in [0.01, 10]", radius_m));
  setup.body = {.name = fmt::format("a disc of {} m", radius_m), .footprint = outline_of_disc(radius_m)};
  setup.settings.routes.cost_weight = plan::GlobalPlannerSettings().family.cost_weight;
}

}  // namespace

PlanSetup load_plan_setup(const PlanOptions& options) {
  if (options.robot && options.radius_m) throw InputError("--robot and --radius-m are mutually exclusive");
  for (const std::string& entry : options.overrides) {
    const bool sets_unknown =
        entry.starts_with("costmap.crosses_unknown") || entry.starts_with("costmap.allow_unknown");
    if (sets_unknown)
      throw InputError("--set: costmap.allow_unknown: not supported: use allow_unknown=true or allow_unknown=false");
  }
  PlanSetup setup;
  PlanSettings& settings = setup.settings;
  if (options.robot) set_robot(*options.robot, find_data_root(options.map), setup);
  if (options.radius_m) set_disc(*options.radius_m, setup);

  std::vector<std::string> overrides = options.overrides;
  if (options.planner && find_named(plan::route_planners(), *options.planner) == nullptr) {
    throw InputError(
        fmt::format("--planner {}: must be one of {}", *options.planner, join(names_of(plan::route_planners()), ", ")));
  }
  if (options.planner) overrides.push_back("planner=" + *options.planner);
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  if (options.smooth) overrides.emplace_back("smooth=true");
  if (options.speed_mps) overrides.push_back(fmt::format("speed_mps={}", *options.speed_mps));
  io::SettingsReader::read_section({"--set", overrides}, io::parse_overrides(overrides), "", settings);
  settings.costmap.allow_unknown = settings.allow_unknown;
  plan::make_route_planner(settings.planner, settings.routes, settings.seed);  // throws for an unknown planner
  if (settings.smooth && settings.planner == "visibility_graph") {
    throw InputError("--smooth: not applicable to the visibility graph, whose paths touch lethal cells");
  }
  return setup;
}

}  // namespace patrol::app
