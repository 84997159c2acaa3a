#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/common/process_cost.h"
#include "app/mapping/consistency_report.h"
#include "app/mapping/log_mapping.h"
#include "app/mapping/odometry_report.h"
#include "core/frames.h"
#include "core/thread_cpu_time.h"
#include "core/time.h"
#include "io/files/csv.h"
#include "io/logs/scan_log.h"
#include "slam/consistency/frozen_scans.h"
#include "slam/consistency/map_consistency.h"

namespace patrol::app {

/// Computation time by segment of scans, which shows whether it grows with the map.
class CostTable {
 public:
  static constexpr std::size_t kScans = 200;  ///< scans per row of the table

  void add(std::size_t num_scans, double distance_m) {
    if (num_scans % kScans != 0) return;
    const double now_s = thread_cpu_time_s();
    table_.rows.push_back(
        {static_cast<double>(num_scans), distance_m, 1e3 * (now_s - last_s_) / kScans, peak_memory_mb()});
    last_s_ = now_s;
  }
  const io::Table& table() const { return table_; }

 private:
  io::Table table_{.name = "performance", .columns = {"scans", "way_m", "ms_per_scan", "peak_memory_mb"}, .rows = {}};
  double last_s_ = thread_cpu_time_s();
};

/// Mapped log: data in addition to the mapper's.
struct MappedLog {
  std::vector<Time> stamps;
  std::vector<Pose2> T_odom_body;  ///< [scan], relative to the first
  double distance_m = 0.0;         ///< distance traveled, by odometry
  slam::ConsistencyCheck consistency;
  slam::FrozenScans frozen;
  CostTable cost;

  double duration_s() const { return stamps.empty() ? 0.0 : to_seconds(stamps.back() - stamps.front()); }
};

/// Maps the scans of a log, which `name` names in the progress. Returns false if the user interrupts.
bool map_log(io::ScanLog& log, const LogMappingSettings& settings, const std::string& name, slam::Mapper& mapper,
             MappedLog& mapped);

/// Agreement of the map of a log with its scans and its odometry.
struct MappingChecks {
  ConsistencyReport consistency;
  OdometryReport odometry;
};

/// Checks a mapped log. `T_map_body`: [scan]; `earlier`: keyframes of earlier sessions in the map.
MappingChecks check_mapping(const MappedLog& mapped, const std::vector<Pose2>& T_map_body,
                            const std::vector<slam::Keyframe>& earlier);

}  // namespace patrol::app
