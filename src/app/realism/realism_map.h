#pragma once

#include "realism/lidar_fit.h"
#include "report/blocks.h"

namespace patrol::app {

/// Map of the expected points of returns on static surfaces, colored by the mean absolute residual in each cell of 5
/// cm, with the path of the lidar.
report::MapBlock residual_map(const realism::ScanSet& set);

/// Plan view of a scan in site: points of the recorded and of the simulated scan.
report::PlanView scan_overlay(const realism::ScanSet& recorded, const realism::ScanSet& simulated, std::size_t scan);

}  // namespace patrol::app
