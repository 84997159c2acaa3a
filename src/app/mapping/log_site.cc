#include "app/mapping/log_site.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/mapping/log_mapping.h"
#include "app/mapping/mapped_log.h"
#include "app/mapping/read_scans.h"
#include "core/error.h"
#include "core/map_cells.h"
#include "importer/site/free_space.h"
#include "importer/site/plan_site.h"
#include "importer/site/wall_segments.h"
#include "slam/calibration/calibration.h"
#include "slam/planar_scan.h"

namespace patrol::app {
namespace {

/// Adds the hits of the scans of a log at their mapped poses, [scan]; false if interrupted.
bool add_hits(const std::filesystem::path& file, const LogMappingSettings& settings,
              const std::vector<Pose2>& T_map_body, importer::WallFitter& walls) {
  const InterruptGuard guard;
  ProgressBar bar;
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, settings.log);
  slam::CalibratedScans calibrated(settings.calibration);
  std::size_t index = 0;
  return read_scans(*log, "walls", guard, bar, [&](RecordedScan& recorded) {
    if (index >= T_map_body.size()) return;
    const Pose2& pose = T_map_body[index++];
    calibrated.correct(recorded);
    const LevelScan scan = slam::planar_scan(recorded, settings.scan);
    for (const LevelScan::Beam& beam : scan.beams) {
      if (beam.is_hit) walls.add(pose * beam.end_m.cast<double>(), pose * scan.origin_m);
    }
  });
}

/// Adds the assumptions and errors of the reader, and the checks of the map that failed.
void add_log_rows(const io::ScanLogSummary& summary, const MappingChecks& checks, importer::ImportedSite& site) {
  for (const std::string& warning : summary.warnings) site.assumptions.push_back({"log", warning, ""});
  for (const auto& [assumption, num_scans] : summary.assumed)
    site.assumptions.push_back({"log", fmt::format("{} {}", num_scans, assumption), ""});
  for (const MappingVerdict& verdict : {checks.consistency.verdict(), checks.odometry.verdict()}) {
    if (verdict.tone != report::Tone::kGood)
      site.assumptions.push_back({"map of the log", verdict.line() + " (patrol slam shows the details)", ""});
  }
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
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(options.file, settings.log);
  MappedLog mapped;
  if (!map_log(*log, settings, "mapping", *mapper, mapped)) return std::nullopt;
  const OccupancyGrid plan = mapper->map();
  const std::vector<Pose2> path = mapper->path();
  if (std::none_of(plan.values().begin(), plan.values().end(), is_occupied))
    throw InputError(options.file.string() + ": the map of the log has no occupied cell");
  importer::WallFitter walls(plan);
  if (!add_hits(options.file, settings, path, walls)) return std::nullopt;
  importer::ImportedSite site = importer::site_of_walls(plan, walls, options);
  add_log_rows(log->summary(), check_mapping(mapped, path, {}), site);
  importer::MissionOptions mission = options.mission;
  if (!mission.start && !path.empty()) mission.start = path.front(), mission.start_is_recorded = true;
  if (mission.start) site.T_site_start = *mission.start;
  importer::add_mission(mission, site);
  if (!site.route) add_recorded_path(path, mission, site);
  return site;
}

}  // namespace patrol::app
