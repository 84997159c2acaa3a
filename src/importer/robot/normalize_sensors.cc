#include "importer/robot/normalize_sensors.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/letter_case.h"
#include "importer/robot/normalize_lidars.h"
#include "importer/robot/normalize_origins.h"

namespace patrol::importer {
namespace {

void add_frame(const std::string& frame, const Pose3& T_base_frame, LinkBuilder& links, NormalizedRobot& robot) {
  robot.sensor_frames.push_back(frame);
  NormalizedLink target{.name = frame};
  target.joint = NormalizedJoint{
      .name = links.new_joint_name(frame + "_joint", "_frame"), .parent = "base_link", .T_parent_link = T_base_frame};
  robot.links.push_back(std::move(target));
}

/// Moves the shapes of the link that carries a lidar to the frame of the lidar: its own beams ignore them. Shapes that
/// are too large for a housing stay.
void move_housing(const RobotLayout& layout, const std::string& frame, const std::string& link,
                  const LinkBuilder& links, NormalizedRobot& robot) {
  constexpr double kMaxHousing_m = 0.3;  // distance from the origin of the beams
  if (link == layout.base || !(frame.starts_with("lidar") || frame == "scanner")) return;
  const std::optional<std::string> name = links.added_name(link);
  if (!name) return;
  NormalizedLink& housing = robot.links.back();
  const auto carrier = std::ranges::find(robot.links, *name, &NormalizedLink::name);
  if (carrier == robot.links.end() || (carrier->visuals.empty() && carrier->collisions.empty())) return;
  const Pose3 T_frame_link = housing.joint->T_parent_link.inverse() * layout.T_base(link);
  const SourceLink& source = layout.source.link(link);
  for (const std::vector<Shape>* shapes : {&source.visuals, &source.collisions}) {
    for (const Shape& shape : *shapes) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        if ((T_frame_link * point).norm() > kMaxHousing_m) return;
      }
    }
  }
  const auto move = [&](std::vector<NormalizedShape>& from, std::vector<NormalizedShape>& to) {
    for (NormalizedShape& shape : from) {
      shape.shape.T_link_shape = T_frame_link * shape.shape.T_link_shape;
      to.push_back(std::move(shape));
    }
    from.clear();
  };
  move(carrier->visuals, housing.visuals);
  move(carrier->collisions, housing.collisions);
  robot.assumptions.push_back({frame, fmt::format("the shapes of {} are its housing: its own beams ignore them", link),
                               "<visual> and <collision> of the link"});
}

bool is_same_pose(const Pose3& a, const Pose3& b) {
  return (a.position - b.position).norm() < 1e-6 && a.rotation.angularDistance(b.rotation) < 1e-6;
}

/// Returns a part of an assumption with the links whose names contain one of the words; empty if there are none. Only
/// the text depends on names.
std::string links_named(const std::set<std::string>& links, std::initializer_list<std::string_view> words) {
  std::vector<std::string> named;
  for (const std::string& link : links) {
    const std::string lower = to_lower(link);
    const auto contains = [&lower](std::string_view word) { return lower.find(word) != std::string::npos; };
    if (std::ranges::any_of(words, contains)) named.push_back(link);
  }
  return named.empty() ? "" : fmt::format("; links with such a name: {}", list_of(named));
}

/// Frames of sensors that the result has.
struct AddedFrames {
  std::set<std::string> names;
  std::map<std::string, Pose3> T_base_described;  ///< poses of the sensors of the file
};

/// Returns the frame that an option gives to a sensor of the file, by its link; none if no option does.
std::optional<std::string> frame_by_option(const NormalizeOptions& options, const SourceSensor& sensor) {
  const auto found = std::ranges::find_if(options.frames, [&sensor](const auto& option) {
    const std::string& kind = option.first == "lidar_rear" ? "lidar" : option.first;
    return kind == sensor.frame && option.second == sensor.link;
  });
  return found == options.frames.end() ? std::nullopt : std::optional(found->first);
}

/// Returns the sensors of the file with the 2D lidars in the order in which they get frames: the one that looks most
/// forward, the one that looks most backward, then the others.
std::vector<SourceSensor> sensors_in_order(const RobotLayout& layout, const NormalizeOptions& options,
                                           std::vector<Assumption>& rows) {
  constexpr double kSameYaw_rad = 0.02;
  const bool has_lidar = options.frames.contains("lidar");
  std::vector<SourceSensor> sensors = layout.source.sensors, lidars;
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].frame != "lidar" || !layout.chassis.contains(sensors[i].link)) continue;
    if (frame_by_option(options, sensors[i])) continue;
    slots.push_back(i);
    lidars.push_back(sensors[i]);
  }
  const auto pose_of = [&layout](const SourceSensor& sensor) {
    return layout.T_base(sensor.link) * sensor.T_link_sensor;
  };
  const auto turn_of = [&](const SourceSensor& sensor) {
    return std::round(std::abs(to_yaw(pose_of(sensor).rotation)) / kSameYaw_rad);
  };
  std::ranges::stable_sort(lidars, [&](const SourceSensor& a, const SourceSensor& b) {
    if (turn_of(a) != turn_of(b)) return turn_of(a) < turn_of(b);
    return pose_of(a).position.x() > pose_of(b).position.x() + 1e-6;
  });
  if (lidars.size() > 1) std::rotate(lidars.begin() + (has_lidar ? 0 : 1), lidars.end() - 1, lidars.end());
  if (lidars.size() > 1 && !has_lidar) {
    const auto description_of = [&](const SourceSensor& sensor) {
      const Pose3 T_base_lidar = pose_of(sensor);
      return fmt::format("{} at x = {:.2f}, y = {:.2f} m, turned by {:.0f} degrees", sensor.link,
                         T_base_lidar.position.x(), T_base_lidar.position.y(),
                         std::round(kDegPerRad * to_yaw(T_base_lidar.rotation)) + 0.0);
    };
    rows.push_back({"lidar, lidar_rear",
                    fmt::format("are the lidars that look most forward and most backward: {}; {}",
                                description_of(lidars[0]), description_of(lidars[1])),
                    "--frame lidar=LINK, --frame lidar_rear=LINK"});
  }
  for (std::size_t i = 0; i < slots.size(); ++i) sensors[slots[i]] = lidars[i];
  return sensors;
}

/// Prepares a frame that was added last: housing, origin and settings of a lidar. `link`: that of the file that has it.
void equip_frame(const RobotLayout& layout, const std::string& frame, const std::string& link,
                 const LidarNumbers& stated, const LinkBuilder& links, NormalizedRobot& robot) {
  move_housing(layout, frame, link, links, robot);
  clear_origin(layout, frame, link, robot);
  check_scan_plane(frame, robot);
  choose_lidar(frame, stated, robot);
}

void add_optional_frames(const RobotLayout& layout, const NormalizeOptions& options, AddedFrames& added,
                         LinkBuilder& links, NormalizedRobot& robot) {
  const std::vector<SourceSensor>& sensors = layout.source.sensors;
  for (const auto& [frame, link] : options.frames) {
    if (!layout.chassis.contains(link)) {
      layout.source.fail(layout.source.link(link).line, link, fmt::format("frame {}: must be on the chassis", frame));
    }
    const auto sensor = std::ranges::find_if(
        sensors, [&](const SourceSensor& each) { return frame_by_option(options, each) == frame; });
    add_frame(frame, layout.T_base(link), links, robot);
    equip_frame(layout, frame, link, sensor == sensors.end() ? LidarNumbers{} : sensor->stated, links, robot);
    added.names.insert(frame);
  }
}

void add_described_sensors(const RobotLayout& layout, const NormalizeOptions& options, AddedFrames& added,
                           LinkBuilder& links, NormalizedRobot& robot) {
  std::map<std::string, std::vector<std::string>> others;
  for (const SourceSensor& sensor : sensors_in_order(layout, options, robot.assumptions)) {
    if (!layout.chassis.contains(sensor.link)) {
      robot.assumptions.push_back({sensor.link,
                                   fmt::format("its sensor of type {} is on a moving part and left out", sensor.frame),
                                   fmt::format("--frame {}=LINK", sensor.frame)});
      continue;
    }
    if (frame_by_option(options, sensor)) continue;
    std::string frame = sensor.frame;
    if (frame == "lidar" && added.names.contains(frame)) frame = "lidar_rear";
    const Pose3 T_base_sensor = layout.T_base(sensor.link) * sensor.T_link_sensor;
    if (!added.names.insert(frame).second) {
      const auto first = added.T_base_described.find(frame);
      // A file may describe one device twice.
      if (first != added.T_base_described.end() && is_same_pose(first->second, T_base_sensor)) continue;
      if (!options.frames.contains(frame)) others[frame].push_back(sensor.link);
      continue;
    }
    added.T_base_described[frame] = T_base_sensor;
    add_frame(frame, T_base_sensor, links, robot);
    robot.assumptions.push_back(
        {frame, fmt::format("is the frame of {}", sensor.link), fmt::format("--frame {}=LINK", frame)});
    equip_frame(layout, frame, sensor.link, sensor.stated, links, robot);
  }
  for (const auto& [frame, others_of_frame] : others) {
    robot.assumptions.push_back({frame,
                                 fmt::format("further sensors of this type are left out: {}", list_of(others_of_frame)),
                                 fmt::format("--frame {}=LINK", frame)});
  }
}

/// Adds an IMU at the center of mass of the chassis.
void add_imu(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  for (const NormalizedLink& link : robot.links) {
    const bool is_fixed = !link.joint || link.joint->is_fixed;
    if (link.inertial && is_fixed) parts.push_back({link.joint ? link.joint->T_parent_link : Pose3{}, *link.inertial});
  }
  add_frame("imu", translation(combine(parts).T_link_inertia.position), links, robot);
  robot.assumptions.push_back({"imu",
                               "is at the center of mass of the chassis: no link of the file has one" +
                                   links_named(layout.chassis, {"imu", "gyro"}),
                               "--frame imu=LINK"});
}

}  // namespace

void add_sensors(const RobotLayout& layout, const NormalizeOptions& options, LinkBuilder& links,
                 NormalizedRobot& robot) {
  AddedFrames added;
  add_optional_frames(layout, options, added, links, robot);
  add_described_sensors(layout, options, added, links, robot);
  if (!added.names.contains("imu")) add_imu(layout, links, robot);
  if (added.names.contains("lidar") || added.names.contains("lidar3d")) return;
  robot.assumptions.push_back({"lidar",
                               "the robot has none: no link of the file has a sensor of type ray or lidar" +
                                   links_named(layout.chassis, {"lidar", "laser", "scan", "velodyne", "hokuyo"}),
                               fmt::format("--frame lidar=LINK, or mounts in {}.yaml", robot.name)});
}

}  // namespace patrol::importer
