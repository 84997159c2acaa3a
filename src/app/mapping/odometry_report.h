#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/mapping/mapping_verdict.h"
#include "core/time.h"
#include "io/json/metrics_json.h"
#include "report/blocks.h"
#include "slam/consistency/odometry_check.h"

namespace patrol::app {

/// Health of the odometry of a log, as told to the user. Times are seconds since the first scan, positions are in map.
struct OdometryReport {
  slam::OdometryHealth health;
  std::vector<Time> stamps;             ///< [scan]
  std::size_t num_frozen_scans = 0;     ///< scans of a frozen lidar (slam/consistency/frozen_scans.h)
  std::size_t num_unmatched_scans = 0;  ///< scans that matched no surfaces of the map, or have no returns

  /// Result in one line: "odometry agrees: ...", "odometry is mostly constant: ..." and others.
  std::string line() const;
  io::Metrics metrics() const;
  report::VerdictBlock block() const;
  MappingVerdict verdict() const;

 private:
  bool is_mostly_unmatched() const;
  double seconds(std::size_t scan) const;
};

}  // namespace patrol::app
