#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/settings.h"
#include "core/trajectory.h"
#include "io/logs/scan_log.h"
#include "realism/posed_scan.h"
#include "realism/simulated_scans.h"
#include "realism/site.h"

namespace patrol::app {

/// Pose of the frame of a path in the site.
struct PathFrameSettings {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("yaw_deg", self.yaw_deg, between(-360.0, 360.0));
  }
};

struct LogOnSiteSettings {
  int max_scans = 400;          ///< scans that are used, evenly over the log
  double lidar_height_m = 0.0;  ///< height of the lidar in site; 0: by path and mount of a run, otherwise 0.4 m. A path
                                ///< of a run without heights has the mean height of the ground truth
  PathFrameSettings path;       ///< pose of the frame of the path in site
  io::ScanLogOptions log;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_scans", self.max_scans, between(4, 100000));
    visit("lidar_height_m", self.lidar_height_m, between(0.0, 1000.0));
    visit("path", self.path);
    visit("log", self.log);
  }
};

/// Names of log, site, path and lidar on the command line.
struct LogOnSiteOptions {
  std::filesystem::path log;  ///< CARMEN or MCAP file, or a run directory
  std::string site;           ///< MJCF file or name of a world; empty: the world of the run
  std::string trajectory;     ///< TUM file, "truth" or "pose"; empty: "truth" of a run
  std::string lidar;          ///< preset (app/scenario/lidar_preset.h); empty: of the run, otherwise rplidar_s2
};

/// Sources of the comparison, resolved.
struct LogOnSite {
  std::filesystem::path log, world_xml;
  std::string path_name, lidar_name;  ///< names for messages and pages
  bool is_run = false;                ///< log of `patrol run`
  Trajectory T_site_body;
  std::optional<Pose3> T_body_lidar;  ///< mount of a run: by the robot's description, with its true path as built;
                                      ///< none: planar, by the log
  /// Lidar of the preset. For a run on its true path, it has the tilt and the cone of the beams as built.
  realism::LidarDevice device;
};

/// Returns whether the options name the ground truth of a run as the path.
bool is_path_exact(const LogOnSiteOptions& options);

/// Resolves the names. Throws InputError.
LogOnSite find_log_on_site(const LogOnSiteOptions& options, const LogOnSiteSettings& settings);

/// Scans of a log at the poses of a path.
struct ScansOnPath {
  std::vector<realism::PosedScan> scans;
  std::size_t num_read = 0;     ///< scans of the log
  std::size_t num_outside = 0;  ///< number of used scans outside of the time of the path
  double lidar_height_m = 0.0;  ///< height of the lidar in site at the first scan
  bool is_height_assumed = false;
  io::ScanLogSummary summary;
};

/// Reads the log, thinned to `max_scans` scans; none if interrupted. Throws InputError if no scan is on the path.
std::optional<ScansOnPath> read_scans_on_path(const LogOnSite& source, const LogOnSiteSettings& settings);

}  // namespace patrol::app
