#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Ball at the end of a leg, in the frame of the last joint.
struct Foot {
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  std::string link = {};   ///< link of the file whose collision shape it is; empty: none
  bool is_sphere = false;  ///< the file has this ball
};

/// Finds the foot of a leg: the sphere at its end, or a ball in the end of its shapes.
Foot find_foot(const RobotLayout& layout, const FoundLeg& leg, std::vector<Assumption>& rows);

/// Returns a cylinder from the knee to the foot that ends before the foot.
Shape shank_of(const Foot& foot);

/// Replaces shapes that reach almost as far as the sphere of the foot: they would touch the ground beside it.
void keep_foot_free(const Foot& foot, const SourceJoint& knee, NormalizedLink& shank, std::vector<Assumption>& rows);

}  // namespace patrol::importer
