#pragma once

#include <cmath>
#include <optional>

#include "core/error.h"
#include "io/logs/scan_log.h"
#include "tests/fuzz/fuzz_input.h"

namespace patrol::test {

inline bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

inline void check_scan(const RecordedScan& recorded) {
  const LaserScan& scan = recorded.scan;
  require(is_finite(recorded.T_odom_body), "odometry is finite");
  require(is_finite(recorded.T_body_lidar), "the lidar's place is finite");
  require(!scan.ranges_m.empty() && scan.ranges_m.size() <= 10'000, "1 ... 10000 beams");
  require(scan.intensities.empty() || scan.intensities.size() == scan.ranges_m.size() ||
              scan.intensities.size() <= 10'000,
          "no endless intensities");
  require(std::isfinite(scan.angle_min_rad) && std::isfinite(scan.angle_increment_rad), "angles are finite");
  require(std::isfinite(scan.range_max_m) && scan.range_max_m > 0.0, "there is a maximum range");
  for (const float range_m : scan.ranges_m) {
    const bool is_measured = range_m > 0.0F && range_m < static_cast<float>(scan.range_max_m);
    require(is_measured || std::isnan(range_m) || std::isinf(range_m), "ranges are measured, or what REP 117 says");
  }
}

/// Returns the number of scans of the log; none if it is refused.
template <typename Log>
std::optional<std::size_t> read_all(const std::filesystem::path& file, bool skip_invalid) {
  io::ScanLogOptions options;
  options.skip_invalid = skip_invalid;
  std::size_t count = 0;
  try {
    Log log(file, options);
    std::optional<Time> last;
    while (const std::optional<RecordedScan> scan = log.next()) {
      check_scan(*scan);
      require(!last || *last <= scan->scan.stamp, "stamps do not fall");
      last = scan->scan.stamp;
      ++count;
    }
    require(count > 0 && log.summary().num_scans == count, "a log that is not refused holds scans");
    require(log.progress() == 1.0, "the log was read to its end");
    require(!io::to_text(log.summary()).empty(), "there is a summary");
  } catch (const InputError&) {
    return std::nullopt;
  }
  return count;
}

/// Checks that skipping of invalid lines does not change the result of a log without such lines.
template <typename Log>
void check_log(const MemoryFile& file) {
  const std::optional<std::size_t> strict = read_all<Log>(file.path(), false),
                                   skipping = read_all<Log>(file.path(), true);
  require(!strict || strict == skipping, "skipping bad lines changes nothing where there are none");
}

}  // namespace patrol::test
