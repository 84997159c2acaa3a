#pragma once

#include <array>
#include <vector>

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Leg of a description: three movable joints in a row.
struct FoundLeg {
  std::array<const SourceJoint*, 3> joints = {};  ///< from the body to the foot
};

/// Finds four legs: chains of three revolute joints from the root, without movable joints below, at the four corners of
/// the robot. Of more chains, the four that end lowest are the legs if they are alike and no other one is like them.
/// The last joints must not be those of wheels. Returns nothing for another robot.
std::vector<FoundLeg> find_legs(const SourceRobot& robot);

}  // namespace patrol::importer
