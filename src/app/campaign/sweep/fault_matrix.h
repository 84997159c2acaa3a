#pragma once

#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "sim/sensors/fault.h"

namespace patrol::app {

/// Faults of every kind for every registered sensor that the scenario uses, from `start_s` on for `duration_s`. The
/// magnitudes of drift and outliers are in the registry (SensorInfo::fault), the others in fault_matrix.cc.
std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s,
                                             double duration_s);

/// Bounds that a run with a fault must meet to have survived.
struct SurvivalBounds {
  double max_error_m = 0.0;       ///< position error at any instant of the run
  double min_map_coverage = 0.0;  ///< fraction of the observable surfaces
  double max_lost_s = 0.0;        ///< time reported lost on a given map
};

/// Overrides that expect the bounds: "expect.pose.ate_max_m={max: 0.3}". A scenario's own expectation of the same
/// metric stands. A scenario without a given map has no bound of the time reported lost.
std::vector<std::string> survival_overrides(const Scenario& scenario, const SurvivalBounds& bounds);

/// Name of a fault's variant: "lidar: drift".
std::string variant_name(const sim::FaultSettings& fault);

/// Fault that a variant's name describes.
struct FaultVariant {
  std::string sensor;  ///< sensor, or the whole name of the variant without a fault
  std::string kind;    ///< empty without a fault
};

FaultVariant parse_variant_name(const std::string& variant_name);

/// Override that sets the fault: "faults=[{...}]".
std::string fault_override(const sim::FaultSettings& fault);

}  // namespace patrol::app
