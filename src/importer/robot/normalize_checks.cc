#include "importer/robot/normalize_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/geometry/convex_polygon.h"
#include "importer/robot/normalize_chassis.h"

namespace patrol::importer {
namespace {

/// Returns the poses of the links of the result in the base.
std::map<std::string, Pose3> new_poses(const NormalizedRobot& robot) {
  std::map<std::string, Pose3> T_base_new;
  for (const NormalizedLink& link : robot.links)
    T_base_new[link.name] = link.joint ? T_base_new.at(link.joint->parent) * link.joint->T_parent_link : Pose3{};
  return T_base_new;
}

Eigen::Vector2d center_of_mass_m(const NormalizedRobot& robot, const std::map<std::string, Pose3>& T_base_new) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  for (const NormalizedLink& link : robot.links) {
    if (link.inertial) parts.push_back({T_base_new.at(link.name), *link.inertial});
  }
  return combine(parts).T_link_inertia.position.head<2>();
}

/// Reports a center of mass that is far from the middle of the feet.
void check_legged_balance(const RobotLayout& layout, NormalizedRobot& robot) {
  double front_m = 0.0, side_m = 0.0;
  for (const FoundLeg& leg : layout.legs) {
    const Eigen::Vector3d hip = layout.T_base(leg.joints.front()->child).position;
    front_m = std::max(front_m, hip.x());
    side_m = std::max(side_m, hip.y());
  }
  const Eigen::Vector2d center = center_of_mass_m(robot, new_poses(robot));
  if (std::abs(center.x()) < 0.15 * front_m && std::abs(center.y()) < 0.15 * side_m + 0.01) return;
  robot.assumptions.push_back(
      {"center of mass",
       fmt::format("is at x = {:.3f}, y = {:.3f} m from the middle of the legs: the trunk tilts", center.x(),
                   center.y()),
       "<inertial> of the links"});
}

/// Reports a center of mass that is not between the contacts with the ground.
void check_balance(NormalizedRobot& robot) {
  const std::map<std::string, Pose3> T_base_new = new_poses(robot);
  std::vector<Eigen::Vector2d> contacts;
  for (const NormalizedLink& link : robot.links) {
    const bool is_wheel = link.joint && !link.joint->is_fixed && std::abs(link.joint->axis.y()) > 0.5;
    if (is_wheel) contacts.push_back(T_base_new.at(link.name).position.head<2>());
  }
  const Eigen::Vector2d center = center_of_mass_m(robot, T_base_new);
  const ConvexPolygon polygon = patrol::convex_hull(contacts);
  double margin_m = polygon.size() < 3 ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3; ++i) {
    const Eigen::Vector2d side = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized(),
                          to = center - polygon[i];
    margin_m = std::min(margin_m, side.x() * to.y() - side.y() * to.x());
  }
  if (margin_m >= 0.01) return;
  robot.assumptions.push_back(
      {"center of mass",
       fmt::format(
           "is at x = {:.3f}, y = {:.3f} m in base_link, {:.3f} m {} the area between the contacts of the wheels: "
           "the robot {}",
           center.x(), center.y(), std::abs(margin_m), margin_m < 0.0 ? "outside" : "inside the edge of",
           margin_m < 0.0 ? "tips over" : "tips when it brakes"),
       "<inertial> of the links"});
}

/// Reports a part of the chassis that touches the ground.
void check_clearance(const RobotLayout& layout, NormalizedRobot& robot) {
  constexpr double kMinClearance_m = 0.005;
  for (const std::string& name : layout.chassis) {
    const SourceLink& link = layout.source.link(name);
    double lowest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < link.collisions.size(); ++i) {
      if (layout.support_shapes.contains({name, i})) continue;
      for (const Eigen::Vector3d& point : outline(link.collisions[i]))
        lowest_m = std::min(lowest_m, (layout.T_base(name) * point).z() - layout.ground_m);
    }
    if (lowest_m >= kMinClearance_m) continue;
    robot.assumptions.push_back({name,
                                 fmt::format("its collision shape is {:.3f} m {} the ground: it drags",
                                             std::abs(lowest_m), lowest_m < 0.0 ? "below" : "above"),
                                 "<collision> of the link"});
  }
}

/// Point of the chassis that meets a ramp first.
struct RampHit {
  std::string link = {};  ///< empty: none
  double angle_rad = 0.0, reach_m = 0.0, height_m = 0.0;
};

/// Returns the point of the chassis beyond a wheel that meets the flattest ramp below an angle. `direction`: 1 ahead,
/// -1 behind. The ground is turned about the wheel as a ramp that it touches.
RampHit ramp_hit(const RobotLayout& layout, const FoundWheel& wheel, double direction, double max_angle_rad) {
  RampHit hit{.angle_rad = max_angle_rad};
  for (const std::string& link : layout.chassis) {
    const std::vector<Shape>& shapes = layout.source.link(link).collisions;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (layout.support_shapes.contains({link, i})) continue;
      for (const Eigen::Vector3d& point : outline(shapes[i])) {
        const Eigen::Vector3d p = layout.T_base(link) * point;
        const double x = direction * (p.x() - wheel.center_m.x()), z = p.z() - layout.ground_m;
        if (x <= 0.0 || z < 0.0) continue;
        // The tangent of the wheel through the point: distance of the point below the axle, and angle to the axle.
        const double below = wheel.radius_m - z, distance = std::hypot(x, below);
        if (distance <= wheel.radius_m) continue;
        const double angle = std::asin(wheel.radius_m / distance) - std::atan2(below, x);
        if (angle < hit.angle_rad) hit = {.link = link, .angle_rad = angle, .reach_m = x, .height_m = z};
      }
    }
  }
  return hit;
}

/// Reports a chassis that hits a ramp of 10 degrees before the wheels do.
void check_ramps(const RobotLayout& layout, NormalizedRobot& robot) {
  constexpr double kRamp_rad = 10.0 / kDegPerRad;
  const std::vector<FoundWheel>& wheels = layout.found.wheels;
  if (wheels.empty()) return;
  for (const double direction : {1.0, -1.0}) {
    const auto ahead = [direction](const FoundWheel& a, const FoundWheel& b) {
      return direction * a.center_m.x() < direction * b.center_m.x();
    };
    const FoundWheel& first = *std::max_element(wheels.begin(), wheels.end(), ahead);
    const RampHit hit = ramp_hit(layout, first, direction, kRamp_rad);
    if (hit.link.empty()) continue;
    robot.assumptions.push_back(
        {hit.link,
         fmt::format("its collision shape reaches {:.2f} m {} the axle, {:.3f} m above the ground: it hits ramps "
                     "steeper than {:.1f} degrees",
                     hit.reach_m, direction > 0.0 ? "ahead of" : "behind", hit.height_m, hit.angle_rad * kDegPerRad),
         "<collision> of the link"});
  }
}

/// Reports a mass that no robot for inspection has.
void check_mass(NormalizedRobot& robot) {
  constexpr double kMax_kg = 20000.0;
  const double mass_kg = total_mass_kg(robot);
  if (mass_kg <= kMax_kg) return;
  const auto mass_of = [](const NormalizedLink& link) { return link.inertial ? link.inertial->mass_kg : 0.0; };
  const auto heaviest = std::max_element(
      robot.links.begin(), robot.links.end(),
      [&mass_of](const NormalizedLink& a, const NormalizedLink& b) { return mass_of(a) < mass_of(b); });
  robot.assumptions.push_back(
      {"mass",
       fmt::format("{:.0f} kg of the file are kept, although more than {:.0f} kg are unlikely: {} has {:.0f} kg",
                   mass_kg, kMax_kg, heaviest->name, mass_of(*heaviest)),
       "<mass> of the links"});
}

/// Reports links that are denser than any material. Links without a considerable part of the mass do not count.
void check_densities(const RobotLayout& layout, NormalizedRobot& robot) {
  constexpr double kMax_kgpm3 = 25000.0, kConsiderable = 0.01;  // of osmium: 22,600 kg/m3; to the mass of the robot
  for (const SourceLink& link : layout.source.links) {
    if (!link.inertial || link.inertial->mass_kg < kConsiderable * layout.extent.mass_kg || !link.has_shapes())
      continue;
    const auto volume_of = [](const std::vector<Shape>& shapes) {
      double sum_m3 = 0.0;
      for (const Shape& shape : shapes) sum_m3 += solid_of(shape).volume_m3;
      return sum_m3;
    };
    const double volume_m3 = std::max(volume_of(link.collisions), volume_of(link.visuals));
    if (volume_m3 <= 0.0 || link.inertial->mass_kg <= kMax_kgpm3 * volume_m3) continue;
    robot.assumptions.push_back(
        {link.name,
         fmt::format("{:.3g} kg of the file are kept, although its shapes of {:.3g} m3 would be of {:.0f} kg/m3: more "
                     "than {:.0f} kg/m3 are unlikely",
                     link.inertial->mass_kg, volume_m3, link.inertial->mass_kg / volume_m3, kMax_kgpm3),
         "<mass> of the link, in kg, or its shapes, in m"});
  }
}

}  // namespace

void check_normalized(const RobotLayout& layout, NormalizedRobot& robot) {
  if (layout.drive == DriveType::kLegs) {
    check_legged_balance(layout, robot);
  } else {
    check_balance(robot);
    check_clearance(layout, robot);
    check_ramps(layout, robot);
  }
  check_mass(robot);
  check_densities(layout, robot);
}

}  // namespace patrol::importer
