#include "app/mapping/log_mapping.h"

#include <optional>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/neighbor_model.h"
#include "slam/graph/range_noise.h"

namespace patrol::app {
namespace {

/// Estimates the standard deviation of the ranges from the first scans; 0 if they do not determine it.
double estimate_range_std_m(const std::filesystem::path& file, const io::ScanLogOptions& options) {
  constexpr int kScans = 200;
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, options);
  slam::RangeNoiseEstimator estimator;
  for (int i = 0; i < kScans; ++i) {
    const std::optional<RecordedScan> recorded = log->next();
    if (!recorded) break;
    estimator.add(recorded->scan);
  }
  return estimator.std_m().value_or(0.0);
}

}  // namespace

std::string adapt_to_log(const std::filesystem::path& log, LogMappingSettings& settings) {
  if (settings.range_std_m == 0.0) settings.range_std_m = estimate_range_std_m(log, settings.log);
  if (!slam::adapt_to_range_noise(settings.range_std_m, settings.slam.graph.scan_odometry)) return "";
  settings.scan.range_std_m = settings.range_std_m;
  return fmt::format("ranges have noise of {:.2f} m: smoothed along the scans\n", settings.range_std_m);
}

std::unique_ptr<slam::Mapper> make_log_mapper(const LogMappingSettings& settings) {
  BoostedStumps neighbors;
  if (needs_neighbor_model(settings.slam.method))
    neighbors = load_neighbor_model(settings.slam.method, find_data_root(""));
  return slam::make_mapper(settings.slam, neighbors, settings.seed);
}

}  // namespace patrol::app
