#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <Eigen/Core>

#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Mission of an imported site. At most one of `stations` and `num_random`.
struct MissionOptions {
  std::filesystem::path stations = {};        ///< CSV with the columns name, x, y and optionally heading_deg, priority,
                                              ///< earliest_s, latest_s, service_s (without effect); empty: none
  int num_random = 0;                         ///< number of random stations in free space
  std::uint64_t seed = 1;                     ///< seed of random stations
  std::optional<Pose2> start = {};            ///< in site; none: by rule
  bool start_is_recorded = false;             ///< the start is that of a recorded path, which needs no clearance
  double clearance_m = 0.5;                   ///< distance of start and stations from walls and unknown space
  double half_width_m = 0.3;                  ///< half width of the robot, which does not fit through narrower passages
  std::string robot = "wheeled";              ///< robot of the scenario
  std::optional<double> lidar_height_m = {};  ///< height of the robot's lidar above the ground; none: without a lidar
};

/// Receives the kind of work that begins, such as "compare scans", and the completed fraction of all work, 0 ... 1.
using ImportProgress = std::function<void(const std::string& work, double fraction)>;

/// Options of `patrol import site`. Each kind of file uses those that its reader names.
struct SiteImportOptions {
  std::filesystem::path file;
  std::string name;              ///< name of the site, its folder and its files
  double wall_height_m = 2.5;    ///< floor plans and logs: height of the walls
  double scale = 0.0;            ///< meshes and points: meters per unit of the file; 0: by rule
  std::string up = {};           ///< meshes and points: axis of the file that points up, y or z; empty: by rule
  double contact_cell_m = 0.05;  ///< meshes and SDF: cell of the contact geometry
  std::map<std::string, std::filesystem::path> packages = {};  ///< SDF: folders of models, by name
  std::set<std::string> without = {};                          ///< SDF: names of models of the world to leave out
  std::map<std::string, std::string> xacro_arguments = {};     ///< SDF: by name
  std::string python = "python3";                              ///< SDF: interpreter that has the package xacro
  MissionOptions mission = {};
  ImportProgress on_progress = {};  ///< scans and points: called during the import; empty: not called
};

/// Gives a site the mission of the options; without stations it has none. A site without a floor plan gets one
/// (site_plan.h). Without a start, the mission begins at the first station of the table or at a random place. Throws
/// InputError if the start or a station is outside the free ground of the plan, has too little clearance, or is not
/// connected to the start. A start inside of a solid is refused without a mission, too.
void add_mission(const MissionOptions& options, ImportedSite& site);

/// Reads a site file of any format but logs (site_format.h) and adds its mission. Throws InputError with one line,
/// "file:line: element: what", or with the known extensions.
ImportedSite import_site(const SiteImportOptions& options);

}  // namespace patrol::importer
