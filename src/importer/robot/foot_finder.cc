#include "importer/robot/foot_finder.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/linear_algebra.h"

namespace patrol::importer {
namespace {

constexpr double kMinFoot_m = 0.008, kMaxFoot_m = 0.08;

/// Shapes of the last link of a leg, in the frame of its joint.
struct LegEnd {
  Foot sphere = {};                               ///< the sphere that reaches farthest, if there is one
  double sphere_m = -1.0;                         ///< reach of this sphere
  double shape_m = 0.0;                           ///< reach of the other shapes
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< farthest point of these
  std::vector<Eigen::Vector3d> points = {};       ///< outlines of these

  void add(const Shape& shape, const Pose3& T_knee_link, const std::string& link) {
    if (shape.type == ShapeType::kSphere) {
      const Eigen::Vector3d center = T_knee_link * shape.T_link_shape.position;
      const double reach_m = center.norm() + shape.radius_m;
      if (reach_m <= sphere_m) return;
      sphere_m = reach_m;
      sphere = {.center_m = center, .radius_m = shape.radius_m, .link = link, .is_sphere = true};
      return;
    }
    for (const Eigen::Vector3d& point : outline(shape)) {
      points.push_back(T_knee_link * point);
      if (points.back().norm() <= shape_m) continue;
      shape_m = points.back().norm();
      end = points.back();
    }
  }
};

LegEnd end_of_leg(const RobotLayout& layout, const SourceJoint& knee) {
  LegEnd end;
  const Pose3 T_base_knee = layout.T_base(knee.child);
  const std::vector<const SourceLink*> links = layout.moving_group(knee);
  const bool has_collision =
      std::ranges::any_of(links, [](const SourceLink* link) { return !link->collisions.empty(); });
  for (const SourceLink* link : links) {
    const Pose3 T_knee_link = T_base_knee.inverse() * layout.T_base(link->name);
    for (const Shape& shape : has_collision ? link->collisions : link->visuals) end.add(shape, T_knee_link, link->name);
  }
  return end;
}

/// Returns the box around the points of the tip of a leg, which is its last tenth along a direction.
Eigen::AlignedBox3d tip_box(const LegEnd& end, const Eigen::Vector3d& direction, const Eigen::Matrix3d& R_tip_knee) {
  constexpr double kTip = 0.9;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : end.points) {
    if (p.dot(direction) > kTip * end.shape_m) box.extend(R_tip_knee * p);
  }
  return box;
}

/// Returns a ball in the end of the shapes of a leg. It is as thick as the tip of the leg.
Foot foot_in_shapes(const LegEnd& end, const SourceJoint& knee) {
  const Eigen::Vector3d direction =
      tip_box(end, end.end.normalized(), Eigen::Matrix3d::Identity()).center().normalized();
  Eigen::Matrix3d R_tip_knee;  // z along the leg, y about along the axis of the knee
  R_tip_knee.row(0) = knee.axis.cross(direction).normalized();
  R_tip_knee.row(1) = direction.cross(Eigen::Vector3d(R_tip_knee.row(0)));
  R_tip_knee.row(2) = direction;
  const Eigen::AlignedBox3d tip = tip_box(end, direction, R_tip_knee);
  const double radius_m =
      std::clamp(0.5 * tip.sizes().head<2>().maxCoeff(), kMinFoot_m, std::min(kMaxFoot_m, 0.15 * end.shape_m));
  const Eigen::Vector3d center(tip.center().x(), tip.center().y(), tip.max().z() - radius_m);
  return {.center_m = R_tip_knee.transpose() * center, .radius_m = radius_m};
}

}  // namespace

Foot find_foot(const RobotLayout& layout, const FoundLeg& leg, std::vector<Assumption>& rows) {
  const SourceJoint& knee = *leg.joints.back();
  const LegEnd end = end_of_leg(layout, knee);
  if (end.sphere.is_sphere && end.shape_m <= end.sphere_m + 0.5 * end.sphere.radius_m) return end.sphere;
  if (end.points.empty()) {
    layout.source.fail(layout.source.link(knee.child).line, knee.child,
                       "the last link of a leg has neither shapes nor a foot: it must have a <collision>");
  }
  const Foot foot = foot_in_shapes(end, knee);
  rows.push_back(
      {knee.child,
       fmt::format("its foot is a ball of radius {:.3f} m in the end of its shapes; the rest of the link is a cylinder",
                   foot.radius_m),
       "<collision> with a <sphere> at the end of the leg"});
  return foot;
}

Shape shank_of(const Foot& foot) {
  const double length_m = foot.center_m.norm();
  return {.type = ShapeType::kCylinder,
          .T_link_shape = {.position = 0.45 * foot.center_m,
                           .rotation = rotation_between(Eigen::Vector3d::UnitZ(), foot.center_m.normalized())},
          .radius_m = 0.6 * foot.radius_m,
          .length_m = 0.7 * length_m};
}

void keep_foot_free(const Foot& foot, const SourceJoint& knee, NormalizedLink& shank, std::vector<Assumption>& rows) {
  constexpr double kFree = 0.4;  // radii beyond the center of the foot
  const double reach_m = foot.center_m.norm() + kFree * foot.radius_m;
  const Eigen::Vector3d direction = foot.center_m.normalized();
  const std::size_t num_removed = std::erase_if(shank.collisions, [&](const NormalizedShape& part) {
    const double cap_m = part.shape.type == ShapeType::kCylinder ? part.shape.radius_m : 0.0;  // in the simulator
    const std::vector<Eigen::Vector3d> points = outline(part.shape);
    return std::any_of(points.begin(), points.end(),
                       [&](const Eigen::Vector3d& p) { return p.dot(direction) + cap_m > reach_m; });
  });
  if (num_removed == 0) return;
  shank.collisions.push_back({.shape = shank_of(foot)});
  rows.push_back({knee.child,
                  "collision shapes that reach to the end of the foot are replaced by a cylinder that ends before it",
                  "<collision> of the link"});
}

}  // namespace patrol::importer
