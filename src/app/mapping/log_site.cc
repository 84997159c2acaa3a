#include "app/mapping/log_site.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/mapping/log_mapping.h"
#include "app/mapping/read_scans.h"
#include "core/error.h"
#include "importer/site/free_space.h"
#include "importer/site/plan_site.h"
#include "importer/site/wall_segments.h"
#include "slam/calibration/calibration.h"
#include "slam/planar_scan.h"

namespace patrol::app {
namespace {

/// Calls `use` with every scan of the log; false if interrupted. `warnings`: those of the reader.
template <typename Use>
bool for_each_scan(const std::filesystem::path& file, const LogMappingSettings& settings, const std::string& label,
                   std::vector<std::string>& warnings, Use&& use) {
  const InterruptGuard guard;
  ProgressBar bar;
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, settings.log);
  slam::CalibratedScans calibrated(settings.calibration);
  const bool is_whole = read_scans(*log, label, guard, bar, [&](RecordedScan& recorded) {
    calibrated.correct(recorded);
    use(slam::planar_scan(recorded, settings.scan), recorded.T_odom_body);
  });
  warnings = log->summary().warnings;
  return is_whole;
}

/// Gives the site the recorded path as its mission, with stations at most every 5 m and at most 100 of them.
void add_recorded_path(const std::vector<Pose2>& path, const importer::MissionOptions& options,
                       importer::ImportedSite& site) {
  constexpr double kSpacing_m = 5.0;
  constexpr double kMaxStations = 100.0, kMinLength_m = 0.5;
  double length_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length_m += (path[i].position() - path[i - 1].position()).norm();
  if (length_m < kMinLength_m)
    throw InputError(
        fmt::format("{}: the recorded path is {:.2f} m long, at least {:g} m are needed for a mission: --stations or "
                    "--random-stations gives another one",
                    site.source, length_m, kMinLength_m));
  const importer::FreeSpace space(*site.map, options.clearance_m, path.front().position());
  const double spacing_m = std::max(kSpacing_m, length_m / kMaxStations);
  site.route = Route{.stations = importer::stations_along(path, space, spacing_m)};
  site.assumptions.push_back(
      {"mission",
       fmt::format("the recorded path, {:.0f} m, a station every {:.1f} m where the clearance is {:.2f} m", length_m,
                   spacing_m, options.clearance_m),
       "--stations or --random-stations"});
}

}  // namespace

std::optional<importer::ImportedSite> import_log_site(const importer::SiteImportOptions& options) {
  LogMappingSettings settings;
  adapt_to_log(options.file, settings);
  const std::unique_ptr<slam::Mapper> mapper = make_log_mapper(settings);
  std::vector<std::string> warnings;
  if (!for_each_scan(options.file, settings, "mapping", warnings,
                     [&](const LevelScan& scan, const Pose2& T_odom_body) { mapper->update(scan, T_odom_body); }))
    return std::nullopt;
  mapper->finish();
  const OccupancyGrid plan = mapper->map();
  const std::vector<Pose2> path = mapper->path();
  importer::WallFitter walls(plan);
  std::size_t index = 0;
  const auto add_hits = [&](const LevelScan& scan, const Pose2&) {
    if (index >= path.size()) return;
    const Pose2& T_map_body = path[index++];
    for (const LevelScan::Beam& beam : scan.beams) {
      if (beam.is_hit) walls.add(T_map_body * beam.end_m.cast<double>(), T_map_body * scan.origin_m);
    }
  };
  if (!for_each_scan(options.file, settings, "walls", warnings, add_hits)) return std::nullopt;
  importer::ImportedSite site = importer::site_of_walls(plan, walls, options.file.filename().string(), options);
  for (const std::string& warning : warnings) site.assumptions.push_back({"log", warning, ""});
  importer::MissionOptions mission = options.mission;
  if (!mission.start && !path.empty()) mission.start = path.front(), mission.start_is_recorded = true;
  if (mission.start) site.T_site_start = *mission.start;
  importer::add_mission(mission, site);
  if (!site.route) add_recorded_path(path, mission, site);
  return site;
}

}  // namespace patrol::app
