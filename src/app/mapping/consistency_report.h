#pragma once

#include <string>
#include <vector>

#include "app/mapping/mapping_verdict.h"
#include "core/time.h"
#include "io/json/metrics_json.h"
#include "report/blocks.h"
#include "slam/consistency/map_consistency.h"

namespace patrol::app {

/// Consistency of a map with the scans of a log, as told to the user. Times are seconds since the first scan, positions
/// are in map.
struct ConsistencyReport {
  slam::MapConsistency consistency;
  std::vector<Time> stamps;  ///< [scan]

  /// Verdict in one line: "consistent: ...", "look at (12.3, -4.5): ..." or "not checked: ...".
  std::string line() const;
  io::Metrics metrics() const;
  report::VerdictBlock block() const;
  /// Places of the largest disagreements and, if too many scans are unmatched, of most of them in a row.
  std::vector<report::MapMark> marks() const;
  MappingVerdict verdict() const;

 private:
  double seconds(std::size_t scan) const;
};

}  // namespace patrol::app
