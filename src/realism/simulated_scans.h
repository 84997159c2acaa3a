#pragma once

#include <cstdint>
#include <vector>

#include "core/sensors/lidar.h"
#include "realism/posed_scan.h"
#include "realism/site.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::realism {

/// Settings and systematic errors of one device.
struct LidarDevice {
  LidarSettings settings;
  sim::LidarErrors errors = {};
};

/// Simulates scans with the beams and the poses of the recorded ones by the lidar model of the simulator (sim::Lidar),
/// [scan][beam]. Number of beams, field of view and minimum range are those of the recorded scan, and the maximum range
/// is at most its own; everything else is that of `device`. Scan k has the random numbers of revolution k. Throws
/// InputError if the scan covers less than 1 or more than 360 degrees.
std::vector<std::vector<float>> simulate_scans(const Site& site, const LidarDevice& device,
                                               const std::vector<PosedScan>& scans, std::uint64_t seed);

}  // namespace patrol::realism
