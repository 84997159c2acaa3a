#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/geometry/convex_polygon.h"
#include "core/letter_case.h"
#include "importer/hull.h"
#include "importer/normalizer.h"

namespace patrol::importer {
namespace {

/// Joins assumptions that differ in the subject only.
std::vector<Assumption> joined(const std::vector<Assumption>& assumptions) {
  std::vector<Assumption> rows;
  for (const Assumption& next : assumptions) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&next](const Assumption& row) {
      return row.text == next.text && row.override_with == next.override_with;
    });
    if (same == rows.end()) rows.push_back(next);
    else if (same->subject != next.subject) same->subject += ", " + next.subject;
  }
  return rows;
}

}  // namespace

void Normalizer::add_frame(const std::string& frame, const Pose3& T_base_frame, const std::string& link) {
  result_.sensor_frames.push_back(frame);
  NormalizedLink target{.name = frame};
  target.joint = NormalizedJoint{
      .name = unique(used_joints_, frame + "_joint", "_frame"), .parent = "base_link", .T_parent_link = T_base_frame};
  result_.links.push_back(std::move(target));
  if (!link.empty()) assume(frame, fmt::format("is the frame of {}", link), fmt::format("--frame {}=LINK", frame));
}

/// Moves the shapes of the link that carries a lidar to the frame of the lidar: its own beams ignore them. Shapes that
/// are too large for a housing stay.
void Normalizer::move_housing(const std::string& frame, const std::string& link) {
  constexpr double kMaxHousing_m = 0.3;  // distance from the origin of the beams
  if (link == base_ || !(frame.starts_with("lidar") || frame == "scanner")) return;
  const auto name = link_names_.find(link);
  if (name == link_names_.end()) return;
  NormalizedLink& housing = result_.links.back();
  const auto carrier = std::ranges::find(result_.links, name->second, &NormalizedLink::name);
  if (carrier == result_.links.end() || (carrier->visuals.empty() && carrier->collisions.empty())) return;
  const Pose3 T_frame_link = housing.joint->T_parent_link.inverse() * T_base(link);
  const SourceLink& source = source_.link(link);
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
  assume(frame, fmt::format("the shapes of {} are its housing: its own beams ignore them", link),
         "<visual> and <collision> of the link");
}

namespace {

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

}  // namespace

/// Returns the frame that an option gives to a sensor of the file, by its link; none if no option does.
std::optional<std::string> Normalizer::frame_by_option(const SourceSensor& sensor) const {
  const auto found = std::ranges::find_if(options_.frames, [&sensor](const auto& option) {
    const std::string& kind = option.first == "lidar_rear" ? "lidar" : option.first;
    return kind == sensor.frame && option.second == sensor.link;
  });
  return found == options_.frames.end() ? std::nullopt : std::optional(found->first);
}

/// Returns the sensors of the file with the 2D lidars in the order in which they get frames: the one that looks most
/// forward, the one that looks most backward, then the others.
std::vector<SourceSensor> Normalizer::sensors_in_order() {
  constexpr double kSameYaw_rad = 0.02;
  const bool has_lidar = options_.frames.contains("lidar");
  std::vector<SourceSensor> sensors = source_.sensors, lidars;
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].frame != "lidar" || !chassis_.contains(sensors[i].link)) continue;
    if (frame_by_option(sensors[i])) continue;
    slots.push_back(i);
    lidars.push_back(sensors[i]);
  }
  const auto pose_of = [this](const SourceSensor& sensor) { return T_base(sensor.link) * sensor.T_link_sensor; };
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
    assume("lidar, lidar_rear",
           fmt::format("are the lidars that look most forward and most backward: {}; {}", description_of(lidars[0]),
                       description_of(lidars[1])),
           "--frame lidar=LINK, --frame lidar_rear=LINK");
  }
  for (std::size_t i = 0; i < slots.size(); ++i) sensors[slots[i]] = lidars[i];
  return sensors;
}

void Normalizer::add_sensors() {
  std::map<std::string, std::vector<std::string>> others;
  std::set<std::string> added;
  std::map<std::string, Pose3> T_base_added;
  for (const auto& [frame, link] : options_.frames) {
    if (!chassis_.contains(link))
      source_.fail(source_.link(link).line, link, fmt::format("frame {}: must be on the chassis", frame));
    add_frame(frame, T_base(link), "");
    move_housing(frame, link);
    clear_origin(frame, link);
    check_scan_plane(frame);
    const auto sensor =
        std::ranges::find_if(source_.sensors, [&](const SourceSensor& each) { return frame_by_option(each) == frame; });
    choose_lidar(frame, sensor == source_.sensors.end() ? LidarNumbers{} : sensor->stated);
    added.insert(frame);
  }
  for (const SourceSensor& sensor : sensors_in_order()) {
    if (!chassis_.contains(sensor.link)) {
      assume(sensor.link, fmt::format("its sensor of type {} is on a moving part and left out", sensor.frame),
             fmt::format("--frame {}=LINK", sensor.frame));
      continue;
    }
    if (frame_by_option(sensor)) continue;
    std::string frame = sensor.frame;
    if (frame == "lidar" && added.contains(frame)) frame = "lidar_rear";
    const Pose3 T_base_sensor = T_base(sensor.link) * sensor.T_link_sensor;
    if (!added.insert(frame).second) {
      const auto first = T_base_added.find(frame);
      // A file may describe one device twice.
      if (first != T_base_added.end() && is_same_pose(first->second, T_base_sensor)) continue;
      if (!options_.frames.contains(frame)) others[frame].push_back(sensor.link);
      continue;
    }
    T_base_added[frame] = T_base_sensor;
    add_frame(frame, T_base_sensor, sensor.link);
    move_housing(frame, sensor.link);
    clear_origin(frame, sensor.link);
    check_scan_plane(frame);
    choose_lidar(frame, sensor.stated);
  }
  for (const auto& [frame, links] : others)
    assume(frame, fmt::format("further sensors of this type are left out: {}", list_of(links)),
           fmt::format("--frame {}=LINK", frame));
  if (!added.contains("imu")) {
    std::vector<std::pair<Pose3, Inertial>> parts;
    for (const NormalizedLink& link : result_.links) {
      const bool is_fixed = !link.joint || link.joint->is_fixed;
      if (link.inertial && is_fixed)
        parts.push_back({link.joint ? link.joint->T_parent_link : Pose3{}, *link.inertial});
    }
    add_frame("imu", translation(combine(parts).T_link_inertia.position), "");
    assume("imu",
           "is at the center of mass of the chassis: no link of the file has one" +
               links_named(chassis_, {"imu", "gyro"}),
           "--frame imu=LINK");
  }
  if (!added.contains("lidar") && !added.contains("lidar3d"))
    assume("lidar",
           "the robot has none: no link of the file has a sensor of type ray or lidar" +
               links_named(chassis_, {"lidar", "laser", "scan", "velodyne", "hokuyo"}),
           fmt::format("--frame lidar=LINK, or mounts in {}.yaml", result_.name));
}

/// Reports a center of mass that is not between the contacts with the ground.
void Normalizer::check_balance() {
  std::map<std::string, Pose3> T_base_new;
  std::vector<std::pair<Pose3, Inertial>> parts;
  std::vector<Eigen::Vector2d> contacts;
  for (const NormalizedLink& link : result_.links) {
    T_base_new[link.name] = link.joint ? T_base_new.at(link.joint->parent) * link.joint->T_parent_link : Pose3{};
    if (link.inertial) parts.push_back({T_base_new.at(link.name), *link.inertial});
    const bool is_wheel = link.joint && !link.joint->is_fixed && std::abs(link.joint->axis.y()) > 0.5;
    if (is_wheel) contacts.push_back(T_base_new.at(link.name).position.head<2>());
  }
  const Eigen::Vector2d center = combine(parts).T_link_inertia.position.head<2>();
  const ConvexPolygon polygon = patrol::convex_hull(contacts);
  double margin_m = polygon.size() < 3 ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3; ++i) {
    const Eigen::Vector2d side = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized(),
                          to = center - polygon[i];
    margin_m = std::min(margin_m, side.x() * to.y() - side.y() * to.x());
  }
  if (margin_m >= 0.01) return;
  assume("center of mass",
         fmt::format(
             "is at x = {:.3f}, y = {:.3f} m in base_link, {:.3f} m {} the area between the contacts of the wheels: "
             "the robot {}",
             center.x(), center.y(), std::abs(margin_m), margin_m < 0.0 ? "outside" : "inside the edge of",
             margin_m < 0.0 ? "tips over" : "tips when it brakes"),
         "<inertial> of the links");
}

/// Reports a part of the chassis that touches the ground.
void Normalizer::check_clearance() {
  constexpr double kMinClearance_m = 0.005;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    double lowest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < link.collisions.size(); ++i) {
      if (support_shapes_.contains({name, i})) continue;
      for (const Eigen::Vector3d& point : outline(link.collisions[i]))
        lowest_m = std::min(lowest_m, (T_base(name) * point).z() - ground_m_);
    }
    if (lowest_m >= kMinClearance_m) continue;
    assume(name,
           fmt::format("its collision shape is {:.3f} m {} the ground: it drags", std::abs(lowest_m),
                       lowest_m < 0.0 ? "below" : "above"),
           "<collision> of the link");
  }
}

/// Reports a chassis that hits a ramp of 10 degrees before the wheels do.
void Normalizer::check_ramps() {
  constexpr double kRamp_rad = 10.0 / kDegPerRad;
  if (found_.wheels.empty()) return;
  for (const double direction : {1.0, -1.0}) {
    const auto ahead = [direction](const FoundWheel& a, const FoundWheel& b) {
      return direction * a.center_m.x() < direction * b.center_m.x();
    };
    const FoundWheel& first = *std::max_element(found_.wheels.begin(), found_.wheels.end(), ahead);
    // Ground turned about the first wheel as a ramp that it touches: angle at which it meets a point.
    double min_angle_rad = kRamp_rad, reach_m = 0.0, height_m = 0.0;
    std::string name;
    for (const std::string& link : chassis_) {
      for (std::size_t i = 0; i < source_.link(link).collisions.size(); ++i) {
        if (support_shapes_.contains({link, i})) continue;
        for (const Eigen::Vector3d& point : outline(source_.link(link).collisions[i])) {
          const Eigen::Vector3d p = T_base(link) * point;
          const double x = direction * (p.x() - first.center_m.x()), z = p.z() - ground_m_;
          if (x <= 0.0 || z < 0.0) continue;
          // The tangent of the wheel through the point: distance of the point below the axle, and angle to the axle.
          const double below = first.radius_m - z, distance = std::hypot(x, below);
          if (distance <= first.radius_m) continue;
          const double angle = std::asin(first.radius_m / distance) - std::atan2(below, x);
          if (angle >= min_angle_rad) continue;
          min_angle_rad = angle, reach_m = x, height_m = z, name = link;
        }
      }
    }
    if (name.empty()) continue;
    assume(name,
           fmt::format("its collision shape reaches {:.2f} m {} the axle, {:.3f} m above the ground: it hits ramps "
                       "steeper than {:.1f} degrees",
                       reach_m, direction > 0.0 ? "ahead of" : "behind", height_m, min_angle_rad * kDegPerRad),
           "<collision> of the link");
  }
}

/// Computes the length and the turning radius, for the settings.
void Normalizer::finish() {
  if (result_.drive == DriveType::kLegs) {
    check_legged_balance();
  } else {
    check_balance();
    check_clearance();
    check_ramps();
  }
  check_mass();
  check_densities();
  result_.assumptions = joined(result_.assumptions);
  double front_m = -std::numeric_limits<double>::infinity(), rear_m = -front_m, left_m = front_m, right_m = rear_m;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        const Eigen::Vector3d p = T_base(name) * point;
        front_m = std::max(front_m, p.x());
        rear_m = std::min(rear_m, p.x());
        left_m = std::max(left_m, p.y());
        right_m = std::min(right_m, p.y());
      }
    }
  }
  double fixed_x = 0.0, num_fixed = 0.0, steered_x = 0.0, num_steered = 0.0, max_angle = kSteering_rad;
  for (const FoundWheel& wheel : found_.wheels) {
    front_m = std::max(front_m, wheel.center_m.x() + wheel.radius_m);
    rear_m = std::min(rear_m, wheel.center_m.x() - wheel.radius_m);
    left_m = std::max(left_m, wheel.center_m.y() + 0.5 * wheel.width_m);
    right_m = std::min(right_m, wheel.center_m.y() - 0.5 * wheel.width_m);
    if (wheel.carrier_type == CarrierType::kSteering) {
      steered_x += wheel.center_m.x();
      ++num_steered;
      if (const auto limits = wheel.carrier->steering_limits())
        max_angle = std::min(std::abs(limits->first), std::abs(limits->second));
    } else if (wheel.carrier_type == CarrierType::kNone) {
      fixed_x += wheel.center_m.x();
      ++num_fixed;
    }
  }
  result_.length_m = front_m - rear_m;
  if (result_.drive == DriveType::kAckermann) choose_keep_out_margin(std::min(left_m - right_m, front_m - rear_m));
  if (num_steered > 0.0) {
    const double wheelbase_m = std::abs(steered_x / num_steered - fixed_x / num_fixed);
    result_.min_turning_radius_m = wheelbase_m / std::tan(std::clamp(max_angle, kMinSteering_rad, 1.5));
  }
}

}  // namespace patrol::importer
