#include "app/run/make_stack_port.h"

#include <utility>

#include <fmt/format.h>

#include "app/run/built_in_stack.h"
#include "app/run/compute_delay.h"
#include "app/run/external_stack.h"
#include "app/run/stack_documents.h"
#include "app/scenario/mounts.h"
#include "core/error.h"
#include "inspect/route_frame.h"
#include "sim/model_assembly.h"
#include "stack/make_stack.h"

namespace patrol::app {
namespace {

stack::LiningReferences references_of(const ScenarioFiles& files) {
  stack::LiningReferences references;
  for (const io::StationScan& scan : files.references) {
    references.emplace(scan.station,
                       inspect::LiningReference{.T_map_scanner = scan.T_map_scanner, .points = scan.points});
  }
  return references;
}

/// Refuses a gas mission without stations. Its type may be the default: few robots have a profile that names another.
void require_stations(const Scenario& scenario, const ScenarioFiles& files) {
  if (scenario.stack.mission_type != "gas" || !files.route.stations.empty()) return;
  throw InputError(fmt::format(
      "{} = gas (robot {}): mission {} has no stations: must have at least one{}",
      scenario.mission_type_location.empty() ? "stack.mission_type" : scenario.mission_type_location, scenario.robot,
      scenario.mission,
      files.goals.empty() && !files.has_teleop() ? "" : ", or use stack.mission_type=tunnel, which drives to goals"));
}

/// A thread of SLAM has work only while corrections are delayed. With it, turns without a delay do not need one of
/// their own. The processor time of a measured turn contains that of SLAM.
std::unique_ptr<StackPort> make_built_in_stack(const Scenario& scenario, const ScenarioFiles& files, bool has_thread) {
  const stack::ComputeSettings& compute = scenario.stack.compute;
  const bool slam_has_thread = has_thread && scenario.stack.slam_delay_s > 0.0 && compute.model != "measured";
  return std::make_unique<BuiltInStack>(make_stack(scenario, files, slam_has_thread), compute,
                                        has_thread && (compute.model == "fixed" || !slam_has_thread));
}

}  // namespace

std::unique_ptr<StackPort> make_stack_port(const Scenario& scenario, const ScenarioFiles& files, StackContext context) {
  if (const std::string warning = warning_of_unused(scenario.stack.compute); !warning.empty())
    fmt::print(stderr, "patrol: warning: {}\n", warning);
  if (scenario.stack.command.empty()) return make_built_in_stack(scenario, files, context.has_thread);
  StackConnection connection{.command = scenario.stack.command,
                             .output = std::move(context.output),
                             .output_name = std::move(context.output_name),
                             .is_interrupted = std::move(context.is_interrupted)};
  return std::make_unique<ExternalStack>(
      stack_documents(scenario, context.scenario, files, context.data_root, sim::tick_of(files.world_xml.string())),
      std::move(connection), scenario.stack);
}

stack::Stack make_stack(const Scenario& scenario, const ScenarioFiles& files, bool has_thread) {
  require_stations(scenario, files);
  return with_location(scenario, [&] {
    return stack::make_stack(scenario.stack, files.robot, inspect::to_map(files.route, files.T_site_start),
                             {.map = files.map,
                              .map_registration = files.map_registration,
                              .goals = files.goals,
                              .references = references_of(files),
                              .neighbor_model = files.neighbor_model,
                              .has_teleop = files.has_teleop(),
                              .site = {.T_site_start = files.T_site_start, .datum = files.datum},
                              .map_period_s = scenario.log.map_period_s,
                              .seed = scenario.seed,
                              .has_thread = has_thread});
  });
}

}  // namespace patrol::app
