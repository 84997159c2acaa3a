#pragma once

#include <string>

#include "core/grid.h"
#include "core/trajectory.h"
#include "io/metrics_json.h"
#include "io/table.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// A log that was mapped.
struct MappingContents {
  std::string log, method;
  OccupancyGrid map;
  Trajectory estimate;   ///< T_map_body
  io::Table cost;        ///< scans, way_m, ms_per_scan, peak_memory_mb
  io::Metrics metrics;
};

/// The page of `patrol slam`: figures, the map with the way, and what scans cost as the map grew.
render::Page mapping_page(const MappingContents& contents);

}  // namespace patrol::app
