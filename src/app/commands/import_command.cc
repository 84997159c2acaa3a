#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/progress_bar.h"
#include "app/common/temporary_folder.h"
#include "app/mapping/log_site.h"
#include "app/record/run_directory.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "importer/robot/robot_import.h"
#include "importer/site/site_format.h"
#include "importer/site/site_import.h"
#include "io/urdf.h"
#include "sim/leg_scale.h"
#include "sim/locomotion/locomotion_settings.h"
#include "sim/locomotion/swing_speed.h"

namespace patrol::app {
namespace {

/// Splits texts NAME=VALUE. Throws InputError for a text without "=" or a name that is given twice.
template <typename Value>
std::map<std::string, Value> to_map(const std::vector<std::string>& texts, const char* option) {
  std::map<std::string, Value> values;
  for (const std::string& text : texts) {
    const std::size_t at = text.find('=');
    if (at == std::string::npos || at == 0) throw InputError(fmt::format("{} {}: must be NAME=VALUE", option, text));
    if (!values.emplace(text.substr(0, at), text.substr(at + 1)).second)
      throw InputError(fmt::format("{} {}: {} is given twice", option, text, text.substr(0, at)));
  }
  return values;
}

/// Returns the last part of a path, also of one that ends with a slash.
std::string folder_name(const std::filesystem::path& folder) {
  const std::filesystem::path normal = folder.lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).filename().string();
}

void print(const std::vector<importer::Assumption>& assumptions, const std::filesystem::path& out) {
  for (const importer::Assumption& assumption : assumptions) {
    fmt::print("{}: {}{}\n", assumption.subject, assumption.text,
               assumption.override_with.empty() ? "" : fmt::format(" [{}]", assumption.override_with));
  }
  fmt::print("{}{} assumptions; {}\n", assumptions.empty() ? "" : "\n", assumptions.size(), out.string());
}

/// Adds an assumption for legs whose joints are too slow for the swing of the slowest walk, or for the speed of walking
/// that the size of the robot allows.
void check_joint_speeds(importer::ImportedRobot& robot) {
  const TemporaryFolder folder("import");
  importer::write_robot(robot, folder.path());
  const RobotDescription description = io::load_robot_description((folder.path() / (robot.name + ".urdf")).string());
  if (description.legs.empty()) return;
  sim::LocomotionSettings walk = sim::scaled_locomotion(description);
  walk.swing_clearance_m = std::min(walk.swing_clearance_m, sim::min_swing_clearance_m(description));
  const double ratio = sim::peak_swing_speed_ratio(description, walk, walk.max_forward_mps);
  const sim::LegScale scale = sim::leg_scale(description);
  const double usual_mps = scale.length / scale.time * sim::LocomotionSettings{}.max_forward_mps;
  constexpr double kSlower = 0.95;
  if (ratio <= 1.0 && walk.max_forward_mps < kSlower * usual_mps) {
    robot.assumptions.push_back(
        {.subject = "speed limits of the legs' joints",
         .text = fmt::format("allow a walk at {:.2f} m/s, instead of the {:.2f} m/s of the size of the robot",
                             walk.max_forward_mps, usual_mps),
         .override_with = "<limit velocity> of the joints, locomotion.max_forward_mps"});
  }
  if (ratio <= 1.0) return;
  robot.assumptions.push_back(
      {.subject = "speed limits of the legs' joints",
       .text = fmt::format(
           "too low: a walk at {:.2f} m/s with {:.1f} cm of clearance below the feet needs {:.1f} times the limits",
           walk.max_forward_mps, 100.0 * walk.swing_clearance_m, ratio),
       .override_with = "<limit velocity> of the joints"});
}

/// Refuses the name of a robot of the data folder: it is found before a robot of the working directory.
void refuse_known_name(const std::string& robot, const std::filesystem::path& out) {
  const std::filesystem::path known = find_data_root({}) / "models" / robot;
  if (!std::filesystem::exists(known / (robot + ".urdf"))) return;
  if (std::filesystem::weakly_canonical(known) == std::filesystem::weakly_canonical(out)) return;
  throw InputError(fmt::format("--out {}: {} is a robot in {}, which would be found first: use another name",
                               out.string(), robot, known.parent_path().string()));
}

/// Prints a warning if the result is not in a folder `folder`, where scenarios look for it.
void warn_of_folder(const std::filesystem::path& out, const std::string& folder) {
  const std::string name = folder_name(out);
  const std::filesystem::path parent = std::filesystem::weakly_canonical(out / "..");
  if (parent.filename() == folder) return;
  fmt::print(stderr, "patrol: warning: --out {}: scenarios find {} in folders named {} only: move it to {}/{}\n",
             out.string(), name, folder, folder, name);
}

/// Sets the height of the lidar of a robot, and the space that it needs to turn in place with a margin, and to pass.
void use_robot(const std::string& name, importer::MissionOptions& mission) {
  constexpr double kMargin_m = 0.1;
  const std::filesystem::path data_root = find_data_root({});
  const RobotDescription robot = load_robot(name, data_root, default_scenario(name, data_root).mounts).description;
  mission.robot = name;
  if (const auto lidar = robot.T_body_sensor.find("lidar"); lidar != robot.T_body_sensor.end())
    mission.lidar_height_m = robot.body_height_m() + lidar->second.position.z();
  mission.clearance_m = robot.outline_radius_m() + kMargin_m;
  mission.half_width_m = 0.0;
  for (const Eigen::Vector2d& corner : robot.footprint_m)
    mission.half_width_m = std::max(mission.half_width_m, std::abs(corner.y()));
}

/// Returns the Python interpreter that tools/setup installs in the source tree, otherwise that of the system.
std::string python_with_xacro() {
  const std::filesystem::path installed = find_data_root({}) / ".deps/python/bin/python3";
  return std::filesystem::exists(installed) ? installed.string() : "python3";
}

importer::ImportedSite import_with_progress(importer::SiteImportOptions options) {
  ProgressBar bar;
  options.on_progress = [&bar, name = options.name](const std::string& work, double fraction) {
    bar.show(fmt::format("import {}: {}", name, work), fraction);
  };
  return importer::import_site(options);
}

/// Returns the assumptions; none, without a folder, if the user interrupts.
std::optional<std::vector<importer::Assumption>> write_unless_interrupted(const importer::ImportedSite& site,
                                                                          const std::filesystem::path& out) {
  const InterruptGuard guard;
  return importer::write_site(site, out, [&] { return guard.is_interrupted(); });
}

}  // namespace

ExitCode import_robot_command(const ImportRobotOptions& options) {
  importer::ImportedRobot robot =
      importer::import_robot({.file = options.file,
                              .name = folder_name(options.out),
                              .packages = to_map<std::filesystem::path>(options.packages, "--package"),
                              .xacro_arguments = to_map<std::string>(options.xacro_arguments, "--xacro-arg"),
                              .python = python_with_xacro(),
                              .base_link = options.base_link,
                              .forward = options.forward,
                              .frames = to_map<std::string>(options.frames, "--frame"),
                              .casters = {options.casters.begin(), options.casters.end()},
                              .drive = options.drive});
  refuse_known_name(robot.name, options.out);
  check_joint_speeds(robot);
  importer::write_robot(robot, options.out);
  print(robot.assumptions, options.out);
  warn_of_folder(options.out, "models");
  return ExitCode::kDone;
}

ExitCode import_site_command(const ImportSiteOptions& options) {
  const std::filesystem::path file = log_of(options.file);
  importer::refuse_unused_options(file, options.given);
  importer::SiteImportOptions import{
      .file = file,
      .name = folder_name(options.out),
      .wall_height_m = options.wall_height_m,
      .scale = options.scale,
      .up = options.up,
      .contact_cell_m = options.contact_cell_m,
      .packages = to_map<std::filesystem::path>(options.packages, "--package"),
      .without = {options.without.begin(), options.without.end()},
      .xacro_arguments = to_map<std::string>(options.xacro_arguments, "--xacro-arg"),
      .python = python_with_xacro(),
      .mission = {.stations = options.stations, .num_random = options.random_stations, .seed = options.seed}};
  if (!options.start.empty()) import.mission.start = parse_pose(options.start, "--start", {}).pose();
  use_robot(options.robot, import.mission);
  const bool is_log = importer::site_format(file) == importer::SiteFormat::kLog;
  const std::optional<importer::ImportedSite> site = is_log ? import_log_site(import) : import_with_progress(import);
  const auto assumptions = site ? write_unless_interrupted(*site, options.out) : std::nullopt;
  if (!assumptions) {
    fmt::print(stderr, "patrol: interrupted; nothing was written\n");
    return ExitCode::kProgramFailed;
  }
  print(*assumptions, options.out);
  warn_of_folder(options.out, "worlds");
  return ExitCode::kDone;
}

}  // namespace patrol::app
