#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "importer/normalizer.h"

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

}  // namespace

/// Replaces small wheels by balls that roll and swivel if they have neither motor nor vertical joint and are not on the
/// only driven axle: fixed in their direction, they would keep the robot from turning.
void Normalizer::release_fixed_casters() {
  if (result_.drive != DriveType::kDifferential) return;
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, min_y = min_x, max_y = -min_x;
  double radius_m = min_x;  // of the smallest driven wheel
  for (const FoundWheel& wheel : found_.wheels) {
    if (!driven_.contains(wheel.joint)) continue;
    min_x = std::min(min_x, wheel.center_m.x());
    max_x = std::max(max_x, wheel.center_m.x());
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
    radius_m = std::min(radius_m, wheel.radius_m);
  }
  const double near_m = 0.1 * (max_y - min_y), axle_m = 0.5 * (min_x + max_x);
  if (max_x - min_x > near_m) return;
  constexpr double kSmall = 0.9;  // to the radius of a driven wheel
  std::erase_if(found_.wheels, [&](const FoundWheel& wheel) {
    const SourceJoint& joint = *wheel.joint;
    const bool is_caster = wheel.carrier_type == CarrierType::kNone && wheel.num_rollers == 0 &&
                           !driven_.contains(&joint) && wheel.radius_m < kSmall * radius_m &&
                           std::abs(wheel.center_m.x() - axle_m) > near_m;
    if (!is_caster) return false;
    kept_.erase(&joint);
    casters_.insert(&joint);
    for (const SourceLink* link : moving_group(joint)) {
      chassis_.insert(link->name);
      for (std::size_t i = 0; i < link->collisions.size(); ++i) support_shapes_.insert({link->name, i});
    }
    supports_.push_back({.name = joint.child,
                         .center_m = {wheel.center_m.x(), wheel.center_m.y(), ground_m_ + wheel.radius_m},
                         .radius_m = wheel.radius_m,
                         .link = joint.child});
    assume(joint.name,
           fmt::format("is a caster: its wheel is smaller than the driven ones and has no motor, and fixed in its "
                       "direction it would keep the robot from turning; replaced by a ball of radius {:.3g} m that "
                       "rolls and swivels freely, with 3 % of the mass",
                       wheel.radius_m),
           "a continuous vertical joint above the wheel, or <limit effort velocity> of the joint");
    return true;
  });
}

/// Finds fixed parts that touch the ground beside the wheels. Boxes and meshes count only if the robot would tip over
/// without them.
void Normalizer::add_supports() {
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, min_y = min_x, max_y = -min_x;
  for (const FoundWheel& wheel : found_.wheels) {
    min_x = std::min(min_x, wheel.center_m.x());
    max_x = std::max(max_x, wheel.center_m.x());
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
  }
  const double gauge_m = max_y - min_y;
  bool needs_support = max_x - min_x < 0.1 * gauge_m && supports_.empty();
  const std::size_t num_casters = supports_.size();
  const auto find = [&](bool with_any_shape) {
    for (const std::string& name : chassis_) {
      const SourceLink& link = source_.link(name);
      const bool is_leaf = name != base_;
      const auto consider = [&](const std::vector<Shape>& shapes, bool is_collision) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          const Shape& shape = shapes[i];
          if (is_collision && support_shapes_.contains({name, i})) continue;
          const bool is_round = is_round_below(shape, T_base(name), is_leaf);
          if (!is_round && !(with_any_shape && is_leaf)) continue;
          const Pose3 T_base_link = T_base(name);
          Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
          for (const Eigen::Vector3d& point : outline(shape)) {
            lower = lower.cwiseMin(T_base_link * point);
            upper = upper.cwiseMax(T_base_link * point);
          }
          double radius_m = 0.5 * (upper - lower).minCoeff();
          double bottom_m = lower.z();
          if (shape.type == ShapeType::kSphere) {
            radius_m = shape.radius_m;
            bottom_m = (T_base_link * shape.T_link_shape.position).z() - radius_m;
          } else if (shape.type == ShapeType::kCylinder) {
            const Eigen::Vector3d axis =
                T_base_link.rotation * (shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ());
            const double lateral = std::hypot(axis.x(), axis.y());
            radius_m = std::abs(axis.z()) < 0.1 ? shape.radius_m : std::min(shape.radius_m, 0.5 * shape.length_m);
            bottom_m = (T_base_link * shape.T_link_shape.position).z() - shape.radius_m * lateral -
                       0.5 * shape.length_m * std::abs(axis.z());
          }
          if (!is_round)
            radius_m = std::max(radius_m, 0.25 * found_.wheels.front().radius_m);  // a ball for its contact
          if (!is_near_ground(bottom_m) || radius_m <= 0.0) continue;
          const Eigen::Vector3d middle = 0.5 * (lower + upper);
          if (!is_round && std::max(upper.x() - lower.x(), upper.y() - lower.y()) > gauge_m) continue;
          if (is_collision) support_shapes_.insert({name, i});
          supports_.push_back({.name = name,
                               .center_m = {middle.x(), middle.y(), ground_m_ + radius_m},
                               .radius_m = radius_m,
                               .link = name == base_ ? "" : name});
          if (std::abs(middle.x() - min_x) > 0.1 * gauge_m) needs_support = false;
        }
      };
      consider(link.collisions, true);
      if (link.collisions.empty()) consider(link.visuals, false);
    }
  };
  find(false);
  if (needs_support) find(true);
  for (std::size_t i = num_casters; i < supports_.size(); ++i) {
    const Support& support = supports_[i];
    assume(support.name,
           fmt::format("is fixed and touches the ground: replaced by a ball of radius {:.3g} m that rolls and swivels "
                       "freely, with 3 % of the mass",
                       support.radius_m),
           "a wheel on two continuous joints");
  }
  if (!needs_support) return;
  // The robot would tip over: a ball below the chassis, on the side of the center of mass.
  std::vector<std::pair<Pose3, Inertial>> parts;
  double front_m = max_x, rear_m = min_x;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    if (link.inertial && link.inertial->mass_kg > 0.0) parts.push_back({T_base(name), to_inertial(*link.inertial)});
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        front_m = std::max(front_m, (T_base(name) * point).x());
        rear_m = std::min(rear_m, (T_base(name) * point).x());
      }
    }
  }
  const double axle_m = 0.5 * (min_x + max_x);
  const double center_m = parts.empty() ? axle_m : combine(parts).T_link_inertia.position.x();
  const double radius_m = 0.25 * found_.wheels.front().radius_m;
  std::vector<double> positions_m;
  if (center_m <= axle_m + 0.02) positions_m.push_back(axle_m + 0.8 * std::min(rear_m - axle_m, -2.0 * radius_m));
  if (center_m >= axle_m - 0.02) positions_m.push_back(axle_m + 0.8 * std::max(front_m - axle_m, 2.0 * radius_m));
  const auto num_balls = static_cast<double>(supports_.size() + positions_m.size());
  for (const double x : positions_m) {
    supports_.push_back({.name = "support",
                         .center_m = {x, 0.5 * (min_y + max_y), ground_m_ + radius_m},
                         .radius_m = radius_m,
                         .link = ""});
    assume(
        "support",
        fmt::format("a ball of radius {:.3g} m at x = {:.3f} m keeps the robot upright, with {:.2g} % of the mass: the "
                    "file has one axle and no caster",
                    radius_m, x, 100.0 * kSupportMassRatio / num_balls),
        "a caster, or a fixed sphere that touches the ground");
  }
}

/// Takes mass from the chassis and returns it: at most a fifth of the mass of base_link.
double Normalizer::take_from_base(double wanted_kg) {
  Inertial& inertial = *base().inertial;
  const double taken_kg = std::min(wanted_kg, 0.2 * inertial.mass_kg);
  inertial.inertia *= 1.0 - taken_kg / inertial.mass_kg;
  inertial.mass_kg -= taken_kg;
  return taken_kg;
}

/// Gives the carriers and wheels of very light casters mass of the chassis, and those with a small inertia an inertia
/// of twice this mass at the radius of the wheel: their contact is unstable otherwise.
void Normalizer::strengthen_casters(double robot_mass_kg) {
  struct CasterPart {
    double radius_m = 0.0;  // of the wheel
    bool rolls = false;
  };
  std::map<std::string, CasterPart> parts;
  for (const FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type != CarrierType::kCaster) continue;
    for (const SourceJoint* joint : {wheel.carrier, wheel.joint})
      parts[link_name(joint->child)] = {wheel.radius_m, joint == wheel.joint};
  }
  constexpr double kLight = 0.3;    // to the mass that a part gets
  constexpr double kInertia = 2.0;  // to mass times radius squared
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(parts.size());
  for (NormalizedLink& link : result_.links) {
    const auto part = parts.find(link.name);
    if (part == parts.end()) continue;
    Inertial& inertial = *link.inertial;
    const double radius_m = part->second.radius_m;
    if (inertial.mass_kg >= kLight * wanted_kg) {
      const auto moment_about = [&inertial](const Eigen::Vector3d& axis) {
        const Eigen::Vector3d in_inertia = inertial.T_link_inertia.rotation.conjugate() * axis;
        return in_inertia.dot(inertial.inertia * in_inertia);
      };
      const double about_swivel = moment_about(Eigen::Vector3d::UnitZ()),
                   about_axle = moment_about(Eigen::Vector3d::UnitY());
      const double before = part->second.rolls ? std::min(about_swivel, about_axle) : about_swivel;
      const double missing = kInertia * wanted_kg * radius_m * radius_m - before;
      if (missing <= 0.0) continue;
      inertial.inertia += missing * Eigen::Matrix3d::Identity();
      assume(link.name,
             fmt::format("its moment of inertia about {} of {:.3g} kg m2 is raised to {:.3g} kg m2: the contact of "
                         "casters with less inertia is unstable in the simulation",
                         part->second.rolls ? "the swivel axis or the axle" : "the swivel axis", before,
                         before + missing),
             "<inertia> of the link");
      continue;
    }
    const double before_kg = inertial.mass_kg;
    inertial.mass_kg += take_from_base(wanted_kg - before_kg);
    const double moment = kInertia * inertial.mass_kg * radius_m * radius_m;
    inertial.inertia = moment * Eigen::Matrix3d::Identity();
    assume(
        link.name,
        fmt::format("its mass of {:.3g} kg is raised to {:.3g} kg, taken from the chassis, and its moments of inertia "
                    "to {:.3g} kg m2: the contact of lighter casters is unstable in the simulation",
                    before_kg, inertial.mass_kg, moment),
        "<mass> of the link");
  }
}

/// Adds a ball that rolls about y in a carrier that swivels about z, with half the radius of trail.
void Normalizer::add_support(const Support& support, double robot_mass_kg) {
  // Lighter balls make the contact of the simulation unstable.
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(supports_.size());
  double mass_kg = 0.0;
  if (!support.link.empty()) {  // the mass of a light part goes to the ball
    for (NormalizedLink& link : result_.links) {
      if (link.name != link_name(support.link) || !link.inertial || link.inertial->mass_kg > 1.5 * wanted_kg) continue;
      mass_kg = link.inertial->mass_kg;
      link.inertial.reset();
    }
  }
  if (mass_kg < wanted_kg) mass_kg += take_from_base(wanted_kg - mass_kg);
  const double half_kg = 0.5 * mass_kg, trail_m = 0.5 * support.radius_m;
  const Inertial ball{.mass_kg = half_kg,
                      .inertia = 0.4 * half_kg * support.radius_m * support.radius_m * Eigen::Matrix3d::Identity()};
  NormalizedLink carrier{.name = unique(used_links_, file_stem(support.name) + "_swivel", ""), .inertial = ball};
  carrier.joint = NormalizedJoint{.name = unique(used_joints_, carrier.name + "_joint", ""),
                                  .parent = "base_link",
                                  .T_parent_link = translation(support.center_m + Eigen::Vector3d(trail_m, 0.0, 0.0)),
                                  .is_fixed = false,
                                  .axis = Eigen::Vector3d::UnitZ()};
  NormalizedLink wheel{.name = unique(used_links_, file_stem(support.name) + "_ball", ""), .inertial = ball};
  wheel.joint = NormalizedJoint{.name = unique(used_joints_, wheel.name + "_joint", ""),
                                .parent = carrier.name,
                                .T_parent_link = translation({-trail_m, 0.0, 0.0}),
                                .is_fixed = false};
  wheel.collisions.push_back({.shape = {.type = ShapeType::kSphere, .radius_m = support.radius_m}});
  result_.links.push_back(std::move(carrier));
  result_.links.push_back(std::move(wheel));
}

}  // namespace patrol::importer
