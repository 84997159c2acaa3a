#include "app/realism/log_on_site.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/mapping/read_scans.h"
#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/lidar_preset.h"
#include "app/scenario/mounts.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/trajectories/tum.h"
#include "sim/as_built/as_built_robot.h"

namespace patrol::app {
namespace {

constexpr double kAssumedHeight_m = 0.4;

/// Scenario of the run that wrote a log; none for other logs.
std::optional<std::filesystem::path> scenario_of_log(const std::filesystem::path& log) {
  std::filesystem::path scenario = log.parent_path() / "scenario.yaml";
  if (log.filename() != "log.mcap" || !std::filesystem::exists(scenario)) return std::nullopt;
  return scenario;
}

std::filesystem::path world_of_site(const std::string& site, const std::filesystem::path& near) {
  if (std::filesystem::is_regular_file(site)) return site;
  if (site.find('/') == std::string::npos) return load_site(site, find_data_root(near)).world_xml;
  throw InputError(fmt::format("--site = {}: must be an MJCF file or the name of a world", site));
}

realism::LidarDevice device_of(const LidarPreset& preset) {
  return {.settings = preset.lidar,
          .errors = {.range_offset_m = preset.as_built.measured_range_offset_m,
                     .range_scale = preset.as_built.measured_range_scale,
                     .reflectivity_m = preset.as_built.measured_reflectivity_m,
                     .incidence_m = preset.as_built.measured_incidence_m}};
}

/// Returns whether all heights are 0, as of the paths of planar estimates.
bool is_planar(const Trajectory& path) {
  return std::ranges::all_of(path, [](const StampedPose& entry) { return entry.pose.position.z() == 0.0; });
}

/// Gives a device the tilt of the axis and the cone of the beams of the lidar as built.
void take_beam_errors(const sim::LidarErrors& drawn, sim::LidarErrors& errors) {
  errors.axis_tilt_x_rad = drawn.axis_tilt_x_rad;
  errors.axis_tilt_y_rad = drawn.axis_tilt_y_rad;
  errors.cone_rad = drawn.cone_rad;
}

/// Lifts a planar path to the mean height of another one.
Trajectory lifted(const Trajectory& path, const Pose2& T_site_path, const Trajectory& heights) {
  double z_m = 0.0;
  for (const StampedPose& entry : heights) z_m += entry.pose.position.z() / static_cast<double>(heights.size());
  Trajectory result;
  for (const StampedPose& entry : path) {
    Pose3 pose = to_pose3(T_site_path) * entry.pose;
    pose.position.z() += z_m;
    result.push_back({entry.stamp, pose});
  }
  return result;
}

Trajectory path_of_run(const std::filesystem::path& log, const RunRecord& record, const std::string& name) {
  if (name == "truth") return record.T_world_body;
  if (record.T_map_body.size() < 2)
    throw InputError(fmt::format("{}: no poses on /pose: use --trajectory truth", log.string()));
  return lifted(record.T_map_body, pose_of_map(record, std::nullopt), record.T_world_body);
}

}  // namespace

bool is_path_exact(const LogOnSiteOptions& options) {
  return options.trajectory == "truth" || options.trajectory.empty();
}

LogOnSite find_log_on_site(const LogOnSiteOptions& options, const LogOnSiteSettings& settings) {
  LogOnSite source;
  source.log = log_of(options.log);
  if (!std::filesystem::is_regular_file(source.log))
    throw InputError(fmt::format("{}: log not found", source.log.string()));
  const std::optional<std::filesystem::path> scenario_file = scenario_of_log(source.log);
  source.is_run = scenario_file.has_value();
  std::string site = options.site, lidar = options.lidar;
  source.path_name = options.trajectory;
  sim::LidarErrors drawn;             // of the lidar of the run
  std::optional<LidarPreset> of_run;  // lidar of the run, unless an option names another
  if (scenario_file) {
    const Scenario scenario = load_scenario(*scenario_file);
    if (site.empty()) site = scenario.world;
    if (lidar.empty()) of_run = LidarPreset{.lidar = scenario.sensors.lidar, .as_built = scenario.as_built.lidar};
    if (source.path_name.empty()) source.path_name = "truth";
    const RobotDescription robot =
        load_robot(scenario.robot, find_data_root(*scenario_file), scenario.mounts).description;
    source.T_body_lidar = robot.T_body("lidar");
    drawn = sim::AsBuiltRobot(scenario.as_built, robot, scenario.seed).lidar("lidar");
  }
  if (site.empty()) throw InputError("--site: required for a log that is not of patrol run");
  if (source.path_name.empty()) throw InputError("--trajectory: required for a log that is not of patrol run");
  source.world_xml = world_of_site(site, scenario_file.value_or(std::filesystem::path()));
  source.lidar_name = of_run ? of_run->lidar.preset : lidar.empty() ? "rplidar_s2" : lidar;
  source.device = device_of(of_run ? *of_run : find_lidar_preset(source.lidar_name, find_data_root({}), "--lidar"));
  const bool is_of_run = source.path_name == "truth" || source.path_name == "pose";
  if (is_of_run && !source.is_run)
    throw InputError(fmt::format("--trajectory = {}: only for a run directory: give a TUM file", source.path_name));
  if (is_of_run) {
    const RunRecord record = read_run_record(source.log);
    source.T_site_body = path_of_run(source.log, record, source.path_name);
    // True poses of the body give those of the beams with the mount and the beams as built only.
    if (source.path_name == "truth") {
      source.T_body_lidar = *source.T_body_lidar * sim::mount_error(record.as_built, "lidar");
      take_beam_errors(drawn, source.device.errors);
    }
  } else {
    source.T_site_body = io::load_tum(source.path_name, io::SameStamps::kKeepFirst);
    if (source.is_run && is_planar(source.T_site_body))
      source.T_site_body = lifted(source.T_site_body, {}, read_run_record(source.log).T_world_body);
  }
  const Pose3 T_site_path = to_pose3({settings.path.x_m, settings.path.y_m, to_rad(settings.path.yaw_deg)});
  for (StampedPose& entry : source.T_site_body) entry.pose = T_site_path * entry.pose;
  return source;
}

std::optional<ScansOnPath> read_scans_on_path(const LogOnSite& source, const LogOnSiteSettings& settings) {
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(source.log, settings.log);
  const auto max_scans = static_cast<std::size_t>(settings.max_scans);
  ScansOnPath result;
  std::vector<RecordedScan> kept;
  std::size_t stride = 1;
  {
    const InterruptGuard guard;
    ProgressBar bar;
    const bool is_whole =
        read_scans(*log, source.log.filename().string(), guard, bar, [&](const RecordedScan& recorded) {
          if (result.num_read++ % stride != 0) return;
          kept.push_back(recorded);
          if (kept.size() < 2 * max_scans) return;
          // Keep every other scan: an even sample of a log of unknown length.
          for (std::size_t k = 1; 2 * k < kept.size(); ++k) kept[k] = std::move(kept[2 * k]);
          kept.resize(max_scans);
          stride *= 2;
        });
    if (!is_whole) return std::nullopt;
  }
  result.summary = log->summary();
  const std::size_t count = std::min(kept.size(), max_scans);
  for (std::size_t k = 0; k < count; ++k) {
    const RecordedScan& recorded = kept[k * kept.size() / count];
    realism::PosedScan posed;
    const Pose3 T_body_lidar = source.T_body_lidar.value_or(to_pose3(recorded.T_body_lidar));
    if (!realism::place_scan(recorded.scan, source.T_site_body, T_body_lidar, posed)) {
      ++result.num_outside;
      continue;
    }
    posed.aim = sim::LidarAim(source.device.errors);
    double lift_m = 0.0;
    if (settings.lidar_height_m > 0.0) lift_m = settings.lidar_height_m - posed.T_site_lidar.front().position.z();
    else if (!source.is_run) lift_m = kAssumedHeight_m, result.is_height_assumed = true;
    for (Pose3& pose : posed.T_site_lidar) pose.position.z() += lift_m;
    result.scans.push_back(std::move(posed));
  }
  if (result.scans.size() < 4)
    throw InputError(fmt::format("{}: only {} of {} scans are within the time of the path {}", source.log.string(),
                                 result.scans.size(), count, source.path_name));
  result.lidar_height_m = result.scans.front().T_site_lidar.front().position.z();
  return result;
}

}  // namespace patrol::app
