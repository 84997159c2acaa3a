#include "app/check/blocked_beams.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/check/check_world.h"
#include "core/frames.h"
#include "core/geometry/angles.h"
#include "core/text.h"
#include "io/files/atomic_file.h"
#include "sim/as_built/as_built_settings.h"
#include "sim/lidar_scene.h"
#include "sim/model_assembly.h"
#include "sim/mujoco.h"

namespace patrol::app {
namespace {

/// Robot in its start posture.
struct StandingRobot {
  const sim::LidarScene& scene;
  Pose3 T_world_body;
  double min_obstacle_z_m = 0.0;  ///< height in body above which the built-in stack takes hits for obstacles
};

/// Casts every `step`-th beam of the rings of a lidar at the robot alone.
BlockedBeams beams_on_robot(const CheckLidar& lidar, const Pose3& T_body_lidar, const StandingRobot& robot, int step) {
  const Pose3 T_world_lidar = robot.T_world_body * T_body_lidar;
  const mjModel& model = robot.scene.model();
  const LidarSettings& settings = lidar.settings;
  const std::uint32_t mask = sim::kRayEverything & ~std::uint32_t{sim::kRayScenery} & ~std::uint32_t{lidar.housing};
  std::map<std::string, int> num_hits;
  int num_blocked = 0, num_cast = 0;
  double max_distance_m = 0.0;
  for (int ring = 0; ring < settings.rings; ++ring) {
    const double part = settings.rings > 1 ? static_cast<double>(ring) / (settings.rings - 1) : 0.0;
    const double elevation = to_rad(std::lerp(settings.elevation_min_deg, settings.elevation_max_deg, part));
    for (int beam = 0; beam < settings.beams; beam += step) {
      ++num_cast;
      const double azimuth = to_rad(settings.fov_deg * (static_cast<double>(beam) / settings.beams - 0.5));
      const Eigen::Vector3d direction{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation)};
      const std::optional<sim::RayHit> hit =
          robot.scene.cast(T_world_lidar.position, T_world_lidar.rotation * direction, settings.range_max_m, mask);
      if (!hit) continue;
      ++num_blocked;
      const Eigen::Vector3d p_body = T_body_lidar * Eigen::Vector3d(hit->distance_m * direction);
      if (p_body.z() >= robot.min_obstacle_z_m) max_distance_m = std::max(max_distance_m, p_body.head<2>().norm());
      ++num_hits[std::string(sim::name_of(model, mjOBJ_BODY, model.geom_bodyid[hit->geom]))];
    }
  }
  std::vector<std::pair<int, std::string>> links;
  for (const auto& [link, num] : num_hits) links.emplace_back(-num, link);
  std::ranges::sort(links);
  BlockedBeams blocked{
      .frame = lidar.frame, .ratio = static_cast<double>(num_blocked) / std::max(num_cast, 1), .links = {}};
  blocked.max_distance_m = max_distance_m;
  for (const auto& [num, link] : links) blocked.links.push_back(link);
  return blocked;
}

/// Returns the mounts at the corners of the tolerance: position, and rotation about x and y. Only the nominal one
/// without as-built errors.
std::vector<Pose3> mount_corners(const sim::AsBuiltSettings& as_built) {
  if (!as_built.enabled) return {Pose3{}};
  const double d = as_built.mounting.position_m, a = to_rad(as_built.mounting.angle_deg);
  std::vector<Pose3> corners;
  for (int i = 0; i < 32; ++i) {
    const auto side = [i](int bit) { return ((i >> bit) & 1) != 0 ? 1.0 : -1.0; };
    corners.push_back({{d * side(0), d * side(1), d * side(2)}, quaternion_from_rpy(a * side(3), a * side(4), 0.0)});
  }
  return corners;
}

/// Returns the blocked beams with the nominal mount, and the largest ratio within the tolerance of the mount.
BlockedBeams beams_within_tolerance(const CheckLidar& lidar, const Pose3& T_body_lidar, const StandingRobot& robot,
                                    const sim::AsBuiltSettings& as_built) {
  constexpr int kMaxBeams = 4000;
  BlockedBeams blocked = beams_on_robot(lidar, T_body_lidar, robot, 1);
  blocked.max_ratio = blocked.ratio;
  blocked.max_links = blocked.links;
  const int step = 1 + lidar.settings.rings * lidar.settings.beams / kMaxBeams;
  for (const Pose3& T_nominal_actual : mount_corners(as_built)) {
    BlockedBeams actual = beams_on_robot(lidar, T_body_lidar * T_nominal_actual, robot, step);
    blocked.max_distance_m = std::max(blocked.max_distance_m, actual.max_distance_m);
    if (actual.ratio <= blocked.max_ratio) continue;
    blocked.max_ratio = actual.ratio;
    blocked.max_links = std::move(actual.links);
  }
  return blocked;
}

}  // namespace

std::vector<BlockedBeams> blocked_beams(const CheckRobot& robot, const std::filesystem::path& folder) {
  if (robot.lidars.empty()) return {};
  const std::filesystem::path world_xml = folder / "blocked_beams.xml";
  io::save_text(world_xml, plane_world().mjcf);
  const sim::AssembledModel model = sim::assemble_model(world_xml.string(), robot.simulator.robot_urdf,
                                                        robot.description, {}, {}, sim::Textures::kNone);
  const sim::DataPtr data = sim::make_data(*model.view);
  std::ranges::copy(model.start_qpos, data->qpos);
  mj_kinematics(model.view.get(), data.get());
  sim::LidarScene scene(*model.view);
  scene.update(*data);
  const int body = mj_name2id(model.view.get(), mjOBJ_BODY, frame_id::kBody);
  const mjtNum* p = data->xpos + 3 * body;
  const mjtNum* q = data->xquat + 4 * body;
  const StandingRobot standing{.scene = scene,
                               .T_world_body = {{p[0], p[1], p[2]}, Eigen::Quaterniond(q[0], q[1], q[2], q[3])},
                               .min_obstacle_z_m = robot.scan_leveling.min_height_m - robot.expected_height_m};
  std::vector<BlockedBeams> result;
  for (const CheckLidar& lidar : robot.lidars)
    result.push_back(
        beams_within_tolerance(lidar, robot.description.T_body(lidar.frame), standing, robot.simulator.as_built));
  return result;
}

std::vector<std::string> warnings_of(const std::vector<BlockedBeams>& lidars,
                                     const localize::ScanLevelerSettings& scan_leveling) {
  constexpr double kManyBeams = 0.05;
  std::vector<std::string> warnings;
  const auto consequence_of = [&](const BlockedBeams& lidar) {
    constexpr double kMargin_m = 0.05;  // noise of the ranges
    const double radius_m = scan_leveling.self_filter_radius_m;
    if (lidar.max_distance_m <= radius_m) return std::string();
    return fmt::format(
        "; these hits are up to {:.2f} m from the middle of the robot, and block its path beyond "
        "stack.scan_leveling.self_filter_radius_m, {:.2f} m: set it to {:.2f} m",
        lidar.max_distance_m, radius_m, lidar.max_distance_m + kMargin_m);
  };
  for (const BlockedBeams& lidar : lidars) {
    if (lidar.ratio >= 1.0) {
      warnings.push_back(fmt::format("all beams of {} hit the robot itself: its frame is enclosed in {}", lidar.frame,
                                     join(lidar.links, ", ")));
    } else if (lidar.max_ratio > std::max(kManyBeams, lidar.ratio + kManyBeams)) {
      warnings.push_back(
          fmt::format("{:.0f} % of the beams of {} hit the robot itself with a mount within the tolerance "
                      "as_built.mounting, {:.0f} % with the nominal mount: {}: raise the frame by mounts{}",
                      100.0 * lidar.max_ratio, lidar.frame, 100.0 * lidar.ratio, join(lidar.max_links, ", "),
                      consequence_of(lidar)));
    } else if (lidar.ratio > kManyBeams) {
      warnings.push_back(fmt::format("{:.0f} % of the beams of {} hit the robot itself: {}{}", 100.0 * lidar.ratio,
                                     lidar.frame, join(lidar.links, ", "), consequence_of(lidar)));
    }
  }
  return warnings;
}

}  // namespace patrol::app
