#include "plan/navigation/local_planner_settings.h"

#include <array>

#include "plan/control/dwa.h"
#include "plan/control/dwa_liu21.h"

namespace patrol::plan {
namespace {

using LocalPlannerFactory = NamedFactory<std::unique_ptr<LocalPlanner>(const LocalPlannerSettings&)>;

std::unique_ptr<LocalPlanner> make_dwa(const LocalPlannerSettings& settings) {
  return std::make_unique<DynamicWindow>(settings.dwa);
}

std::unique_ptr<LocalPlanner> make_dwa_liu21(const LocalPlannerSettings& settings) {
  return std::make_unique<DwaLiu21>(settings.dwa_liu21);
}

constexpr std::array kLocalPlanners = std::to_array<LocalPlannerFactory>({
    {"dwa", "Dynamic window approach over forward simulated arcs", make_dwa},
    {"dwa_liu21", "Dynamic window approach as printed in [Liu21]", make_dwa_liu21},
});

}  // namespace

std::span<const LocalPlannerFactory> local_planners() { return kLocalPlanners; }

}  // namespace patrol::plan
