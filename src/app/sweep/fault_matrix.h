#pragma once

#include <string>
#include <vector>

#include "app/scenario.h"
#include "sim/sensors/fault.h"

namespace patrol::app {

/// Every kind of fault of every sensor of the registry that the scenario uses, from `start_s` on for `duration_s`.
/// The magnitudes of drift and spikes are in the registry (SensorInfo::fault), the others in fault_matrix.cc.
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
