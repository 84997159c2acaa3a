#include "plan/navigation/local_planner_settings.h"

#include <array>

namespace patrol::plan {
namespace {

using Settings = LocalPlannerSettings;
using Planner = std::unique_ptr<LocalPlanner>;

constexpr std::array kLocalPlanners = std::to_array<NamedFactory<Planner(const Settings&)>>({
    {"dwa", "Dynamic window approach over forward simulated arcs",
     [](const Settings& settings) -> Planner { return std::make_unique<DynamicWindow>(settings.dwa); }},
    {"dwa_liu21", "Dynamic window approach as printed in [Liu21]",
     [](const Settings& settings) -> Planner { return std::make_unique<DwaLiu21>(settings.dwa_liu21); }},
});

}  // namespace

std::span<const NamedFactory<Planner(const Settings&)>> local_planners() { return kLocalPlanners; }

}  // namespace patrol::plan
