#pragma once

#include <string>
#include <vector>

#include "app/scenario.h"
#include "sim/sensors/fault.h"

namespace patrol::app {

/// Every kind of fault of every sensor that the scenario's robot has switched on, and of its remote control if it is driven by one; from
/// `start_s` on for `duration_s`. How large each is stands in fault_matrix.cc.
std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s, double duration_s);

/// "lidar: drift".
std::string variant_name(const sim::FaultSettings& fault);

/// What a variant's name says.
struct FaultVariant {
  std::string sensor;  ///< or the whole name, of the variant without a fault
  std::string kind;    ///< empty: no fault
};

FaultVariant fault_of(const std::string& variant_name);

/// "faults=[{...}]".
std::string fault_override(const sim::FaultSettings& fault);

}  // namespace patrol::app
