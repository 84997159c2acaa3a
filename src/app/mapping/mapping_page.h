#pragma once

#include <string>

#include "app/mapping/consistency_report.h"
#include "app/mapping/odometry_report.h"
#include "core/grid.h"
#include "core/trajectory.h"
#include "io/files/table.h"
#include "io/json/metrics_json.h"
#include "report/blocks.h"

namespace patrol::app {

/// Results of mapping a log.
struct MappingContents {
  std::string log, method;
  OccupancyGrid map;
  Trajectory estimate;  ///< T_map_body
  io::Table cost;       ///< scans, way_m, ms_per_scan, peak_memory_mb
  io::Metrics metrics;
  ConsistencyReport consistency;
  OdometryReport odometry;
};

/// Report page of `patrol slam`: metrics, the map with the trajectory, the health of the odometry, and the computation
/// time of scans as the map grows.
report::Page mapping_page(const MappingContents& contents);

}  // namespace patrol::app
