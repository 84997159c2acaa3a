#include "importer/robot/normalize_supports.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "importer/robot/normalize_inertias.h"

namespace patrol::importer {
namespace {

/// Returns whether a shape touches the ground as a ball or a wheel does. An upright cylinder of the base is the
/// chassis.
bool is_round_below(const Shape& shape, const Pose3& T_base_link, bool is_leaf) {
  if (shape.type == ShapeType::kSphere) return true;
  if (shape.type != ShapeType::kCylinder) return false;
  constexpr double kUpright = 0.9;
  const Eigen::Vector3d axis = T_base_link.rotation * (shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ());
  return is_leaf || std::abs(axis.z()) < kUpright;
}

/// Area of the centers of wheels in the base.
struct WheelArea {
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, min_y = min_x, max_y = -min_x;

  void extend(const FoundWheel& wheel) {
    min_x = std::min(min_x, wheel.center_m.x());
    max_x = std::max(max_x, wheel.center_m.x());
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
  }
  double gauge_m() const { return max_y - min_y; }
  double axle_m() const { return 0.5 * (min_x + max_x); }
};

/// Part of a shape that may touch the ground, in the base.
struct ShapeBottom {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = -lower;
  double radius_m = 0.0;  ///< radius of the ball that replaces the shape
  double bottom_m = 0.0;
};

ShapeBottom bottom_of(const Shape& shape, const Pose3& T_base_link) {
  ShapeBottom part;
  for (const Eigen::Vector3d& point : outline(shape)) {
    part.lower = part.lower.cwiseMin(T_base_link * point);
    part.upper = part.upper.cwiseMax(T_base_link * point);
  }
  part.radius_m = 0.5 * (part.upper - part.lower).minCoeff();
  part.bottom_m = part.lower.z();
  if (shape.type == ShapeType::kSphere) {
    part.radius_m = shape.radius_m;
    part.bottom_m = (T_base_link * shape.T_link_shape.position).z() - part.radius_m;
  } else if (shape.type == ShapeType::kCylinder) {
    const Eigen::Vector3d axis = T_base_link.rotation * (shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ());
    const double lateral = std::hypot(axis.x(), axis.y());
    part.radius_m = std::abs(axis.z()) < 0.1 ? shape.radius_m : std::min(shape.radius_m, 0.5 * shape.length_m);
    part.bottom_m = (T_base_link * shape.T_link_shape.position).z() - shape.radius_m * lateral -
                    0.5 * shape.length_m * std::abs(axis.z());
  }
  return part;
}

/// Returns the ball that replaces a shape of the chassis which touches the ground; none for another shape.
std::optional<Support> support_of(const RobotLayout& layout, const std::string& link, const Shape& shape,
                                  bool with_any_shape, double gauge_m) {
  const bool is_leaf = link != layout.base;
  const Pose3 T_base_link = layout.T_base(link);
  const bool is_round = is_round_below(shape, T_base_link, is_leaf);
  if (!is_round && !(with_any_shape && is_leaf)) return std::nullopt;
  const ShapeBottom part = bottom_of(shape, T_base_link);
  double radius_m = part.radius_m;
  if (!is_round) radius_m = std::max(radius_m, 0.25 * layout.found.wheels.front().radius_m);  // a ball for its contact
  if (!layout.is_near_ground(part.bottom_m) || radius_m <= 0.0) return std::nullopt;
  const Eigen::Vector3d size = part.upper - part.lower;
  if (!is_round && std::max(size.x(), size.y()) > gauge_m) return std::nullopt;
  const Eigen::Vector3d middle = 0.5 * (part.lower + part.upper);
  return Support{.name = link,
                 .center_m = {middle.x(), middle.y(), layout.ground_m + radius_m},
                 .radius_m = radius_m,
                 .link = is_leaf ? link : ""};
}

/// Adds the shapes of the chassis that touch the ground. Returns whether one of them is not on the axle.
bool add_touching_shapes(RobotLayout& layout, const WheelArea& area, bool with_any_shape) {
  bool is_off_axle = false;
  for (const std::string& name : layout.chassis) {
    const SourceLink& link = layout.source.link(name);
    const bool is_collision = !link.collisions.empty();
    const std::vector<Shape>& shapes = bounding_shapes(link);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (is_collision && layout.support_shapes.contains({name, i})) continue;
      const auto support = support_of(layout, name, shapes[i], with_any_shape, area.gauge_m());
      if (!support) continue;
      if (is_collision) layout.support_shapes.insert({name, i});
      layout.supports.push_back(*support);
      if (std::abs(support->center_m.x() - area.min_x) > 0.1 * area.gauge_m()) is_off_axle = true;
    }
  }
  return is_off_axle;
}

/// Returns the positions along x of balls below the chassis of a robot that would tip over: on the side of the center
/// of mass, or on both.
std::vector<double> ball_positions_m(const RobotLayout& layout, const WheelArea& area, double radius_m) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  double front_m = area.max_x, rear_m = area.min_x;
  for (const std::string& name : layout.chassis) {
    const SourceLink& link = layout.source.link(name);
    if (link.inertial && link.inertial->mass_kg > 0.0)
      parts.push_back({layout.T_base(name), to_inertial(*link.inertial)});
    for (const Shape& shape : bounding_shapes(link)) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        front_m = std::max(front_m, (layout.T_base(name) * point).x());
        rear_m = std::min(rear_m, (layout.T_base(name) * point).x());
      }
    }
  }
  const double axle_m = area.axle_m();
  const double center_m = parts.empty() ? axle_m : combine(parts).T_link_inertia.position.x();
  std::vector<double> positions_m;
  if (center_m <= axle_m + 0.02) positions_m.push_back(axle_m + 0.8 * std::min(rear_m - axle_m, -2.0 * radius_m));
  if (center_m >= axle_m - 0.02) positions_m.push_back(axle_m + 0.8 * std::max(front_m - axle_m, 2.0 * radius_m));
  return positions_m;
}

/// Adds balls below the chassis that keep a robot with one axle upright.
void add_balls(RobotLayout& layout, const WheelArea& area, std::vector<Assumption>& rows) {
  const double radius_m = 0.25 * layout.found.wheels.front().radius_m;
  const std::vector<double> positions_m = ball_positions_m(layout, area, radius_m);
  const auto num_balls = static_cast<double>(layout.supports.size() + positions_m.size());
  for (const double x : positions_m) {
    layout.supports.push_back({.name = "support",
                               .center_m = {x, 0.5 * (area.min_y + area.max_y), layout.ground_m + radius_m},
                               .radius_m = radius_m,
                               .link = ""});
    rows.push_back(
        {"support",
         fmt::format("a ball of radius {:.3g} m at x = {:.3f} m keeps the robot upright, with {:.2g} % of the mass: "
                     "the file has one axle and no caster",
                     radius_m, x, 100.0 * kSupportMassRatio / num_balls),
         "a caster, or a fixed sphere that touches the ground"});
  }
}

}  // namespace

void release_fixed_casters(RobotLayout& layout, std::vector<Assumption>& rows) {
  if (layout.drive != DriveType::kDifferential) return;
  WheelArea area;  // of the driven wheels
  double radius_m = std::numeric_limits<double>::infinity();
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (!layout.driven.contains(wheel.joint)) continue;
    area.extend(wheel);
    radius_m = std::min(radius_m, wheel.radius_m);
  }
  const double near_m = 0.1 * area.gauge_m(), axle_m = area.axle_m();
  if (area.max_x - area.min_x > near_m) return;
  constexpr double kSmall = 0.9;  // to the radius of a driven wheel
  std::erase_if(layout.found.wheels, [&](const FoundWheel& wheel) {
    const SourceJoint& joint = *wheel.joint;
    const bool is_caster = wheel.carrier_type == CarrierType::kNone && wheel.num_rollers == 0 &&
                           !layout.driven.contains(&joint) && wheel.radius_m < kSmall * radius_m &&
                           std::abs(wheel.center_m.x() - axle_m) > near_m;
    if (!is_caster) return false;
    layout.kept.erase(&joint);
    layout.casters.insert(&joint);
    for (const SourceLink* link : layout.moving_group(joint)) {
      layout.chassis.insert(link->name);
      for (std::size_t i = 0; i < link->collisions.size(); ++i) layout.support_shapes.insert({link->name, i});
    }
    layout.supports.push_back({.name = joint.child,
                               .center_m = {wheel.center_m.x(), wheel.center_m.y(), layout.ground_m + wheel.radius_m},
                               .radius_m = wheel.radius_m,
                               .link = joint.child});
    rows.push_back(
        {joint.name,
         fmt::format("is a caster: its wheel is smaller than the driven ones and has no motor, and fixed in its "
                     "direction it would keep the robot from turning; replaced by a ball of radius {:.3g} m that "
                     "rolls and swivels freely, with 3 % of the mass",
                     wheel.radius_m),
         "a continuous vertical joint above the wheel, or <limit effort velocity> of the joint"});
    return true;
  });
}

void find_supports(RobotLayout& layout, std::vector<Assumption>& rows) {
  WheelArea area;
  for (const FoundWheel& wheel : layout.found.wheels) area.extend(wheel);
  const std::size_t num_casters = layout.supports.size();
  bool needs_support = area.max_x - area.min_x < 0.1 * area.gauge_m() && num_casters == 0;
  if (add_touching_shapes(layout, area, false)) needs_support = false;
  if (needs_support && add_touching_shapes(layout, area, true)) needs_support = false;
  for (std::size_t i = num_casters; i < layout.supports.size(); ++i) {
    const Support& support = layout.supports[i];
    rows.push_back({support.name,
                    fmt::format("is fixed and touches the ground: replaced by a ball of radius {:.3g} m that rolls and "
                                "swivels freely, with 3 % of the mass",
                                support.radius_m),
                    "a wheel on two continuous joints"});
  }
  if (needs_support) add_balls(layout, area, rows);
}

}  // namespace patrol::importer
