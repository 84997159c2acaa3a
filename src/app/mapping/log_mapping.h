#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/settings.h"
#include "io/logs/scan_log.h"
#include "slam/calibration/calibration.h"
#include "slam/methods/mapper.h"
#include "slam/planar_scan.h"

namespace patrol::app {

/// Settings of the mapping of a recorded log: `patrol slam --set`.
struct LogMappingSettings {
  std::uint64_t seed = 1;
  io::ScanLogOptions log;
  slam::Calibration calibration;
  double range_std_m = 0.0;  ///< standard deviation of the ranges; 0: estimated from the first scans
  slam::PlanarScanSettings scan;
  slam::MapperSettings slam;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("seed", self.seed);
    visit("log", self.log);
    visit("calibration", self.calibration);
    visit("range_std_m", self.range_std_m, at_least(0.0));
    visit("scan", self.scan);
    visit("slam", self.slam);
  }
};

/// Sets the standard deviation of the ranges, unless it is given, from the first scans of a log. Noisy ranges are
/// smoothed along the scans, and the settings of the method `graph` are adapted. Returns a line about the adaptation;
/// empty if there was none. Throws InputError.
std::string adapt_to_log(const std::filesystem::path& log, LogMappingSettings& settings);

/// Creates the mapper of `settings.slam`. Throws InputError.
std::unique_ptr<slam::Mapper> make_log_mapper(const LogMappingSettings& settings);

}  // namespace patrol::app
